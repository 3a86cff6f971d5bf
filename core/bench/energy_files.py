"""The files of the benchmark of the energy."""

from collections.abc import Mapping
from pathlib import Path

from ..files import made_folder, whole_file
from .energy import EnergyFigures
from .markdown import readme_section, whole_report
from .plots import pictures

README = "readme.md"
README_PICTURES = "core/bench/plots"
"""Where the README's pictures lie, seen from it."""


def write_energy_files(figures: EnergyFigures, folder: Path) -> list[Path]:
    """Writes energy.md, readme.md and the plots.

    Raises:
        MocapError: they cannot be written.
    """
    texts = {
        "energy.md": whole_report(figures),
        README: readme_section(figures, README_PICTURES),
        **{f"{name}.svg": text for name, text in pictures(figures).items()},
    }
    return write_texts(texts, folder)


def write_texts(texts: Mapping[str, str], folder: Path) -> list[Path]:
    """Writes files by their names.

    Raises:
        MocapError: they cannot be written.
    """
    made_folder(folder)
    paths = [folder / name for name in texts]
    for path, text in zip(paths, texts.values(), strict=True):
        with whole_file(path) as partial:
            partial.write_text(text, "utf-8", newline="\n")
    return paths
