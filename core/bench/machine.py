"""What the figures were measured on."""

import os
import platform
from pathlib import Path

from ..native.library import load
from ..results.report import versions

CODE_PATHS = {1: "base", 3: "x86-64-v3", 4: "x86-64-v4"}
"""The kernel's, by their numbers in it."""


def code_path() -> int:
    """Number of the best of the kernel's code paths that this processor has.

    Raises:
        MocapError: the kernel is missing.
    """
    return load().sm_processor()


def machine(renderer: str | None) -> dict:
    """Processor, the kernel's code path, cores, load, system and versions.

    ``renderer`` is OpenGL's name for what draws.

    Asked before anything is measured, the load is that of others: processes that want a core.
    """
    try:
        cores = len(os.sched_getaffinity(0))
    except AttributeError:
        cores = os.cpu_count() or 1
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    return {
        "processor": _processor(),
        "code_path": CODE_PATHS[code_path()],
        "cores": cores,
        "load_before": load,
        "opengl": renderer,
        **versions(),
    }


def machine_words(facts: dict) -> str:
    """The machine in one line."""
    drawn = f", OpenGL by {facts['opengl']}" if facts["opengl"] else ""
    load = "" if facts["load_before"] is None else f" (load {facts['load_before']:.1f} before)"
    cores = f"{facts['cores']} cores{load}"
    path = f"kernel on its {facts['code_path']} path"
    system = f"{facts['machine']}, Python {facts['python']}"
    return f"{facts['processor']}, {path}, {cores}, {system}{drawn}"


def _processor() -> str:
    names = Path("/proc/cpuinfo")
    lines = names.read_text("utf-8").splitlines() if names.exists() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.processor() or platform.machine()
