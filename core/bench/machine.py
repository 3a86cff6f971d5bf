"""What the figures were measured on."""

import os
import platform
from pathlib import Path

from ..results.report import versions


def machine(renderer: str | None) -> dict:
    """Processor, cores, system and versions; ``renderer`` is OpenGL's name for what draws."""
    try:
        cores = len(os.sched_getaffinity(0))
    except AttributeError:
        cores = os.cpu_count() or 1
    return {"processor": _processor(), "cores": cores, "opengl": renderer, **versions()}


def machine_words(facts: dict) -> str:
    """The machine in one line."""
    drawn = f", OpenGL by {facts['opengl']}" if facts["opengl"] else ""
    python = f"Python {facts['python']}"
    return f"{facts['processor']}, {facts['cores']} cores, {facts['machine']}, {python}{drawn}"


def _processor() -> str:
    names = Path("/proc/cpuinfo")
    lines = names.read_text("utf-8").splitlines() if names.exists() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.processor() or platform.machine()
