"""The files of the benchmark of tracking."""

from pathlib import Path

from .energy_files import README_PICTURES, write_texts
from .tracking import TrackingFigures
from .tracking_markdown import readme_section, tracking_report
from .tracking_plots import tracking_pictures
from .tracking_report import confidence_of, rows_of

README = "tracking_readme.md"


def report_text(figures: TrackingFigures) -> str:
    """All tables."""
    rows, confidence = rows_of(figures.results), confidence_of(figures.results)
    return tracking_report(figures.machine, rows, confidence, figures.speed)


def write_tracking_files(figures: TrackingFigures, folder: Path) -> list[Path]:
    """Writes tracking.md, tracking_readme.md and the plots.

    Raises:
        MocapError: they cannot be written.
    """
    rows, confidence = rows_of(figures.results), confidence_of(figures.results)
    texts = {
        "tracking.md": tracking_report(figures.machine, rows, confidence, figures.speed),
        README: readme_section(figures.machine, rows, confidence, figures.speed, README_PICTURES),
    }
    pictures = tracking_pictures(rows, confidence)
    return write_texts(texts | {f"{name}.svg": text for name, text in pictures.items()}, folder)
