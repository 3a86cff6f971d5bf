"""What the figures were measured on."""

import os
import platform
from pathlib import Path

from ..results.report import versions


def machine(renderer: str | None) -> dict:
    """Processor, cores, load, system and versions; ``renderer`` is OpenGL's name for what draws.

    Asked before anything is measured, the load is that of others: processes that want a core.
    """
    try:
        cores = len(os.sched_getaffinity(0))
    except AttributeError:
        cores = os.cpu_count() or 1
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    facts = {"processor": _processor(), "cores": cores, "load_before": load, "opengl": renderer}
    return {**facts, **versions()}


def machine_words(facts: dict) -> str:
    """The machine in one line."""
    drawn = f", OpenGL by {facts['opengl']}" if facts["opengl"] else ""
    load = "" if facts["load_before"] is None else f" (load {facts['load_before']:.1f} before)"
    cores = f"{facts['cores']} cores{load}"
    return f"{facts['processor']}, {cores}, {facts['machine']}, Python {facts['python']}{drawn}"


def _processor() -> str:
    names = Path("/proc/cpuinfo")
    lines = names.read_text("utf-8").splitlines() if names.exists() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.processor() or platform.machine()
