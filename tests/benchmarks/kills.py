"""Kills ``fit`` at random moments and resumes it: does it come to the same, bit by bit?

    python tests/benchmarks/kills.py sample_scenes/walk/take.toml --kills 100

One undisturbed fit is the measure. Each trial starts a fit, ends it after a random time with
SIGKILL, which no program can catch, and lets ``fit --resume`` finish. The files of poses, body and
overlay must be equal byte by byte, the report but for its times.
"""

import argparse
import json
import random
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

SAME_BYTES = ("motion.npz", "body.npz", "overlay.mp4")
TIMES = ("seconds_per_frame",)


@dataclass(frozen=True)
class Trial:
    """One killed and resumed fit.

    Attributes:
        killed_after: seconds.
        kept: frames that were finished by then.
        differing: what is not as in the undisturbed fit.
    """

    killed_after: float
    kept: int
    differing: tuple[str, ...]


def main() -> int:
    """Runs the trials; 1 where any result differs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("take", type=Path)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--frames", default=":", help="A:B, as for fit")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="kills_") as scratch:
        trials = run(arguments, Path(scratch))
    same = sum(not trial.differing for trial in trials)
    kept = sorted(trial.kept for trial in trials)
    print(
        f"{len(trials)} kills after {min(t.killed_after for t in trials):.1f} to "
        f"{max(t.killed_after for t in trials):.1f} s, {kept[0]} to {kept[-1]} frames kept "
        f"({kept.count(0)} times none): {same} results equal bit by bit"
    )
    return 0 if same == len(trials) else 1


def run(arguments: argparse.Namespace, scratch: Path) -> list[Trial]:
    """The trials; each is told as it ends."""
    words = ["fit", str(arguments.take), "--frames", arguments.frames, "--export", "none"]
    whole, rng, trials = scratch / "whole", random.Random(arguments.seed), []
    start = time.monotonic()
    assert started(words, whole).wait() == 0
    duration = time.monotonic() - start
    print(f"undisturbed: {duration:.1f} s", flush=True)
    while len(trials) < arguments.kills:
        out = scratch / "killed"
        shutil.rmtree(out, ignore_errors=True)
        trial = killed_and_resumed(words, out, whole, rng.uniform(0, duration))
        if trial is None:
            continue
        trials.append(trial)
        verdict = f"differs in {', '.join(trial.differing)}" if trial.differing else "equal"
        print(
            f"{len(trials):4d}  killed after {trial.killed_after:6.2f} s, "
            f"{trial.kept:3d} frames kept: {verdict}",
            flush=True,
        )
    return trials


def started(words: list[str], out: Path, *more: str) -> subprocess.Popen:
    """The command in a process of its own."""
    return subprocess.Popen(
        [sys.executable, "-m", "silhouette_mocap", *words, "--out", str(out), *more],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip


def killed_and_resumed(words: list[str], out: Path, whole: Path, delay: float) -> Trial | None:
    """One trial; None where the fit was finished before it could be killed."""
    process = started(words, out)
    try:
        process.wait(delay)
        return None
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    kept = len(list((out / "unfinished" / "pictures").glob("[0-9]*.jpg")))
    code = started(words, out, "--resume").wait()
    differing = tuple(differences(out, whole)) if code == 0 else (f"exit code {code}",)
    return Trial(delay, kept, differing)


def differences(out: Path, whole: Path) -> list[str]:
    """Names of what is not as in ``whole``."""
    found = [n for n in SAME_BYTES if (out / n).read_bytes() != (whole / n).read_bytes()]
    reports = [json.loads((folder / "report.json").read_text("utf-8")) for folder in (out, whole)]
    for report in reports:
        for name in TIMES:
            del report[name]
    names = sorted(path.name for path in out.iterdir())
    if names != sorted(path.name for path in whole.iterdir()):
        found.append(f"files {names}")
    return found + ["report.json"] * (reports[0] != reports[1])


if __name__ == "__main__":
    sys.exit(main())
