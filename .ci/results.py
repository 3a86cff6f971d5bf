"""Prints one table of fits: error, fit to the footage, speed and files.

.ci/results.py FOLDER…        folders that `silhouette-mocap fit` wrote
"""

import json
import sys
from pathlib import Path

COLUMNS = (
    "result", "frames", "absolute mm", "offsets removed mm", "IoU", "contour px", "lost",
    "s/frame", "evaluations/frame", "mm per px",
)  # fmt: skip


def row(folder: Path) -> tuple[str, ...]:
    """The columns of one result."""
    report = json.loads((folder / "report.json").read_text("utf-8"))
    frames = len(report["frames"])
    error = report["error_mm"] or {}
    scales = [camera["mm_per_px"] for camera in report["cameras"].values()]
    return (
        folder.name,
        str(frames),
        number(error.get("absolute", {}).get("mean"), 1),
        number(error.get("offset_removed", {}).get("mean"), 1),
        number(report["iou"], 3),
        number(report["contour_px"], 2),
        str(len(report["lost_frames"])),
        number(sum(report["seconds_per_frame"]) / frames, 2),
        number(sum(report["evaluations_per_frame"]) / frames, 0),
        f"{min(scales):.1f} to {max(scales):.1f}",
    )


def number(value: float | None, digits: int) -> str:
    """The rounded number, or a dash where there is none."""
    return "-" if value is None else f"{value:.{digits}f}"


def main(folders: list[Path]) -> None:
    """Prints the table, then IoU per camera and the files of each result."""
    rows = [COLUMNS, *(row(folder) for folder in folders)]
    widths = [max(len(cells[i]) for cells in rows) for i in range(len(COLUMNS))]
    print()
    for cells in rows:
        print("  ".join(cell.rjust(width) for cell, width in zip(cells, widths, strict=True)))
    print()
    for folder in folders:
        report = json.loads((folder / "report.json").read_text("utf-8"))
        views = ", ".join(f"{k} {number(v, 3)}" for k, v in report["iou_per_camera"].items())
        print(f"IoU of {folder.name}: {views}")
    for folder in folders:
        files = sorted(p for p in folder.iterdir() if p.is_file())
        sizes = (f"{p.name} ({p.stat().st_size / 1024:.0f} KB)" for p in files)
        print(f"files in {folder}: {', '.join(sizes)}")


if __name__ == "__main__":
    main([Path(name) for name in sys.argv[1:]])
