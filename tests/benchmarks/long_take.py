"""Memory and disk over a fit of very many frames: does either grow with the take?

    cd tests && python -m benchmarks.long_take [--frames 10000] [--svg FILE] [--json FILE]

A take of a few poses that go back and forth, their masks linked again and again (160 x 120 px, four
cameras), is fitted in a child process with the default tracker. Its resident memory and the size of
its output folder are looked at while its progress is read: every so many frames while it fits, and
twice a second throughout. What the fit holds more than after 200 frames comes from the number of
frames; so does what later stages hold beyond it, but for the encoder of the overlay.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import cv2
import numpy as np
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.cameras.presets import Ring, ring
from silhouette_mocap.core.rendering.native import NativeEvaluator
from small_take import TAKE, calibration_of

SETTLED_FRAMES = 200
MOST_GROWTH_MB = 30.0
# after them: moments compared and an encoder, and the arrays of the results with their copies
MOST_LATER_MB, MOST_LATER_MB_PER_FRAME = 15.0, 0.0025
POSES = 24
PROGRAM = "import sys; from silhouette_mocap.core.cli import main; sys.exit(main(sys.argv[1:]))"


@dataclass(frozen=True)
class Sample:
    """The process at one moment.

    Attributes:
        seconds: since it began.
        task: what it is at; empty before the first.
        done: frames of the task that are finished.
        memory_mb: resident memory.
        disk_mb: of the output folder.
    """

    seconds: float
    task: str
    done: int
    memory_mb: float
    disk_mb: float


def write_take(folder: Path, frames: int) -> Path:
    """A take of ``frames`` frames, of which only a few have pictures of their own."""
    body = template("sixteen_segment")
    cameras = ring(Ring(4, heights=(1.0, 2.0), size=(160, 120), focal_px=137.0))
    poses = np.zeros((POSES, len(body.dofs)))
    poses[:, 0] = np.linspace(0, 0.4, POSES)
    poses[:, body.dofs.names.index("left_elbow_flexion")] = np.linspace(0, 1.2, POSES)
    evaluator = NativeEvaluator(body, cameras)
    for camera in cameras:
        (folder / "masks" / camera.name).mkdir(parents=True)
    for frame in range(frames):
        place = frame % (2 * POSES - 2)
        model = min(place, 2 * POSES - 2 - place)
        drawn = evaluator.silhouettes(poses[model]) if frame < POSES else [None] * len(cameras)
        for camera, picture in zip(cameras, drawn, strict=True):
            path = folder / "masks" / camera.name
            if picture is None:
                os.link(path / f"{model:06d}.png", path / f"{frame:06d}.png")
            else:
                cv2.imwrite(str(path / f"{frame:06d}.png"), picture.astype(np.uint8) * 255)
    (folder / "calibration.toml").write_text("\n".join(map(calibration_of, cameras)), "utf-8")
    text = TAKE.replace("[0, 3]", f"[0, {frames - 1}]").replace('"small"', '"long"')
    (folder / "take.toml").write_text(text, "utf-8")
    return folder / "take.toml"


class Watch:
    """A fit in a child process, looked at from outside."""

    def __init__(self, take: Path, out: Path):
        words = ["fit", str(take), "--out", str(out), "--progress", "json", "--export", "none"]
        self.out, self.begun = out, time.monotonic()
        self.task, self.done = "", 0
        self.process = subprocess.Popen(
            [sys.executable, "-c", PROGRAM, *words], stderr=subprocess.PIPE, text=True
        )

    def samples(self, step: int) -> Iterator[Sample]:
        """One every ``step`` frames of the fit, and one every half second."""
        found: list[Sample] = []
        clock = threading.Thread(target=self._tick, args=(found,), daemon=True)
        clock.start()
        assert self.process.stderr is not None
        for line in self.process.stderr:
            event = json.loads(line)
            if event["event"] == "begin":
                self.task, self.done = event["task"], 0
            elif event["event"] == "frame":
                self.done = event["done"]
                if event["task"] == "fit" and self.done % step == 0:
                    found.append(self._sample())
            elif event["event"] == "fault":
                raise SystemExit(event["line"])
        clock.join()
        yield from sorted(found, key=lambda sample: sample.seconds)

    def _tick(self, found: list[Sample]) -> None:
        while self.process.poll() is None:
            found.append(self._sample())
            time.sleep(0.5)

    def _sample(self) -> Sample:
        try:
            pages = int(Path(f"/proc/{self.process.pid}/statm").read_text().split()[1])
        except (OSError, IndexError):
            pages = 0
        memory = pages * os.sysconf("SC_PAGE_SIZE") / 2**20
        seconds = time.monotonic() - self.begun
        return Sample(seconds, self.task, self.done, memory, _folder_mb(self.out))


def _folder_mb(folder: Path) -> float:
    total = 0
    for place, _, names in os.walk(folder):
        for name in names:
            try:
                total += os.stat(os.path.join(place, name)).st_size
            except FileNotFoundError:
                # a temporary name, gone by now
                continue
    return total / 2**20


def report(samples: Sequence[Sample], step: int) -> str:
    """The table, and what grew."""
    fit = [sample for sample in samples if sample.task == "fit" and sample.memory_mb]
    rows = [f"{'frames':>8}{'seconds':>10}{'memory MB':>12}{'disk MB':>10}"]
    by_done = {sample.done: sample for sample in fit if sample.done % step == 0 and sample.done}
    for done, sample in by_done.items():
        rows.append(
            f"{done:>8}{sample.seconds:>10.1f}{sample.memory_mb:>12.1f}{sample.disk_mb:>10.2f}"
        )
    for task in dict.fromkeys(sample.task for sample in samples):
        peak = max(sample.memory_mb for sample in samples if sample.task == task)
        rows.append(f"peak while at {task or 'start'!r}: {peak:.1f} MB")
    return "\n".join(rows)


def growth(samples: Sequence[Sample]) -> float:
    """MB that the fit held at most beyond what it held after `SETTLED_FRAMES`."""
    fit = [s for s in samples if s.task == "fit" and s.done >= SETTLED_FRAMES and s.memory_mb]
    return max(sample.memory_mb for sample in fit) - fit[0].memory_mb


def later_growth(samples: Sequence[Sample]) -> float:
    """MB that the stages after the fit held at most beyond what it held."""
    tasks = [sample.task for sample in samples]
    begin = tasks.index("fit")
    end = len(tasks) - tasks[::-1].index("fit")
    most = [max(s.memory_mb for s in part) for part in (samples[begin:end], samples[end:])]
    return most[1] - most[0]


def drawing(samples: Sequence[Sample]) -> str:
    """Memory and disk over time as SVG."""
    width, height, left, low = 720, 300, 60, 260
    end, top = samples[-1].seconds, max(s.memory_mb for s in samples) * 1.1

    def line(values: Sequence[float], colour: str) -> str:
        points = " ".join(
            f"{left + (width - left - 10) * s.seconds / end:.1f},{low - 240 * v / top:.1f}"
            for s, v in zip(samples, values, strict=True)
        )
        return f'<polyline fill="none" stroke="{colour}" stroke-width="1.5" points="{points}"/>'

    heights = {mark: low - 240 * mark / top + 4 for mark in np.linspace(0, round(top, -1), 5)}
    marks = "".join(
        f'<text x="{left - 6}" y="{y:.1f}" text-anchor="end">{mark:g}</text>'
        for mark, y in heights.items()
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>'
        f'<line x1="{left}" y1="{low}" x2="{width - 10}" y2="{low}" stroke="#888"/>{marks}'
        + line([s.memory_mb for s in samples], "#1f5fa8")
        + line([s.disk_mb for s in samples], "#c0571b")
        + f'<text x="{left}" y="{height - 12}">MB over {end:.0f} s: memory blue, disk orange</text>'
        "</svg>\n"
    )


def main() -> int:
    """Fits and prints; 1 where memory grew by more than it may."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=10_000)
    parser.add_argument("--every", type=int, default=500)
    parser.add_argument("--svg", type=Path)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="long_take_") as scratch:
        folder = Path(scratch) / "session" / "long"
        folder.mkdir(parents=True)
        watch = Watch(write_take(folder, arguments.frames), Path(scratch) / "out")
        samples = list(watch.samples(min(arguments.every, SETTLED_FRAMES)))
        code = watch.process.wait()
    print(report(samples, arguments.every))
    grown, later = growth(samples), later_growth(samples)
    print(
        f"exit code {code}; from {SETTLED_FRAMES} frames to the last, memory grew by {grown:.1f} "
        f"MB, and by {later:.1f} MB after them"
    )
    if arguments.svg:
        arguments.svg.write_text(drawing(samples), "utf-8")
    if arguments.json:
        arguments.json.write_text(json.dumps([asdict(sample) for sample in samples]), "utf-8")
    most = MOST_LATER_MB + MOST_LATER_MB_PER_FRAME * arguments.frames
    return 0 if code == 0 and grown <= MOST_GROWTH_MB and later <= most else 1


if __name__ == "__main__":
    sys.exit(main())
