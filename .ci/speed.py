"""Puts what ``make bench`` measured into the README: its block on speed, and the plots beside it.

python .ci/speed.py out/bench
"""

import re
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "core" / "bench" / "plots"
BLOCK = re.compile(r"(<!-- speed: begin[^\n]*-->\n).*?(<!-- speed: end -->)", re.DOTALL)


def main(folder: Path) -> None:
    """Rewrites the block; ``folder`` holds readme.md and the plots."""
    readme = ROOT / "README.md"
    section = (folder / "readme.md").read_text("utf-8")
    text, count = BLOCK.subn(
        lambda found: f"{found[1]}\n{section}\n{found[2]}", readme.read_text("utf-8")
    )
    if count != 1:
        sys.exit(f"{readme} has no block between <!-- speed: begin --> and <!-- speed: end -->")
    readme.write_text(text, "utf-8", newline="\n")
    PICTURES.mkdir(exist_ok=True)
    for picture in folder.glob("*.svg"):
        shutil.copyfile(picture, PICTURES / picture.name)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
