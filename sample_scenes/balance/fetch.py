"""Fetches the real recording of a man balancing on a beam, filmed by four cameras.

Footage, calibration and stills are the demonstration of Pose2Sim (BSD-3-Clause, David Pagnon and
contributors). They are taken out of its Python package, fetched by pip, and stay out of this
repository:

    python sample_scenes/balance/fetch.py [--out sample_scenes/balance/data]
"""

import argparse
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

PACKAGE = "pose2sim==0.10.49"
DEMO = "Pose2Sim/Demo_SinglePerson/"
CAMERAS = ("cam01", "cam02", "cam03", "cam04")
FILES = {
    f"{DEMO}calibration/Calib.qca.txt": "Calib.qca.txt",
    **{f"{DEMO}videos/{name}.mp4": f"videos/{name}.mp4" for name in CAMERAS},
    **{
        f"{DEMO}calibration/extrinsics/{name}_ext.png": f"stills/{name}_ext.png" for name in CAMERAS
    },
}


def main() -> int:
    """Fetches what is missing; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "data")
    out = parser.parse_args().out
    if all((out / name).is_file() for name in FILES.values()):
        print(f"{out}: complete")
        return 0
    with tempfile.TemporaryDirectory() as folder:
        try:
            wheel = downloaded(Path(folder))
            count = unpacked(wheel, out)
        except (OSError, KeyError, zipfile.BadZipFile, subprocess.CalledProcessError) as error:
            reason = getattr(error, "stderr", None) or str(error)
            last = reason.strip().splitlines()[-1:] or ["no reason given"]
            print(f"cannot fetch {PACKAGE}: {last[0]}; check the network", file=sys.stderr)
            return 2
    print(f"{out}: {count} files of {PACKAGE}")
    return 0


def downloaded(folder: Path) -> Path:
    """The package's wheel, fetched by pip into ``folder``."""
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps"]
    command += ["--only-binary", ":all:", "--disable-pip-version-check", "--retries", "1"]
    command += ["--dest", str(folder), PACKAGE]
    subprocess.run(command, check=True, capture_output=True, text=True)
    return next(folder.glob("*.whl"))


def unpacked(wheel: Path, out: Path) -> int:
    """Writes the demonstration's files to ``out``; returns how many."""
    with zipfile.ZipFile(wheel) as archive:
        for source, target in FILES.items():
            path = out / target
            path.parent.mkdir(parents=True, exist_ok=True)
            partial = path.with_name(path.name + ".partial")
            partial.write_bytes(archive.read(source))
            partial.replace(path)
    return len(FILES)


if __name__ == "__main__":
    sys.exit(main())
