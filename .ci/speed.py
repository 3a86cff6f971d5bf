"""Puts what was measured into the README, block by block, and the plots beside it.

python .ci/speed.py out/bench        whatever `make bench` and `make bench-tracking` left there
"""

import re
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "core" / "bench" / "plots"
SECTIONS = {"readme.md": "speed", "tracking_readme.md": "tracking"}
"""File of the folder and name of its block."""


def main(folder: Path) -> None:
    """Rewrites the blocks whose files ``folder`` holds, and takes its plots over."""
    readme = ROOT / "README.md"
    text = readme.read_text("utf-8")
    for name, block in SECTIONS.items():
        file = folder / name
        if file.is_file():
            text = with_block(text, block, file.read_text("utf-8"))
    readme.write_text(text, "utf-8", newline="\n")
    PICTURES.mkdir(exist_ok=True)
    for picture in folder.glob("*.svg"):
        shutil.copyfile(picture, PICTURES / picture.name)


def with_block(text: str, block: str, section: str) -> str:
    """``text`` with ``section`` between the marks of ``block``."""
    marks = rf"(<!-- {block}: begin[^\n]*-->\n).*?(<!-- {block}: end -->)"
    found, count = re.subn(marks, lambda m: f"{m[1]}\n{section}\n{m[2]}", text, flags=re.DOTALL)
    if count != 1:
        sys.exit(f"the README has no block <!-- {block}: begin --> to <!-- {block}: end -->")
    return found


if __name__ == "__main__":
    main(Path(sys.argv[1]))
