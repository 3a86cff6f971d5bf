"""Writes core/cli/FAULTS.md: every fault of the input and the line that tells it.

.ci/faults.py        makes each fault in a copy of a small take and runs the command on it
"""

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests/command")]

from fault_chapters import CHAPTERS  # noqa: E402
from faults import Chapter, met, table_row  # noqa: E402
from small_take import write_small_take  # noqa: E402

HEAD = """# What is said of a faulty input

Each fault ends the command with exit code 2 and this one line on standard error. Faults with "yes"
are found by `info`, too, before anything is fitted. Made by `.ci/faults.py` with the faults that
the tests make; paths count from the take's session folder.
"""
COLUMNS = "| fault | by `info` | line |\n|---|---|---|\n"


def chapter_text(chapter: Chapter, small_take: Path, sessions: Path) -> str:
    """The chapter's title and table; a fault that cannot be made here is left out."""
    rows = []
    for fault in chapter.faults:
        if fault.unless:
            print(f"{fault.title}: {fault.unless}")
            continue
        session = Path(tempfile.mkdtemp(dir=sessions))
        told, _ = met(fault, small_take, session)
        rows.append(table_row(fault, told.shown(session)))
    return f"\n## {chapter.title}\n\n{COLUMNS}{''.join(rows)}"


def main() -> None:
    """Writes the file."""
    with tempfile.TemporaryDirectory() as folder:
        original = Path(folder) / "session" / "small"
        original.mkdir(parents=True)
        small_take = write_small_take(original)
        chapters = [chapter_text(chapter, small_take, Path(folder)) for chapter in CHAPTERS]
    (ROOT / "core/cli/FAULTS.md").write_text(HEAD + "".join(chapters), "utf-8")


if __name__ == "__main__":
    main()
