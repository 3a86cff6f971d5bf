"""Coverage-guided fuzzing of the native kernel's entry points.

    cd tests && python -m benchmarks.fuzz_kernel [--seconds 60] [--seed 0] [--folder FOLDER]

Bytes become bodies, cameras, weights and poses (``benchmarks/kernel``): sound ones, those with
numbers nobody expects, and those with spoilt indices and planes, which must be refused or drawn
without harm. Every code path must say the same, and what it says must fit together: silhouettes
are what the snapped triangles cover, energies weigh silhouettes, masked weights give the full
energy. All of it runs under AddressSanitizer and UndefinedBehaviorSanitizer (gcc). The corpus
stays in the folder and is gone on with; so does every failing case, to be run again by
``FOLDER/build/fuzz FOLDER/failure-*``.
"""

import argparse
import os
import struct
import subprocess
import sys
import time
from pathlib import Path

from benchmarks.sanitized import ENVIRONMENT, build_fuzzer

MOST_FAILURES = 20
FOLDER = Path(__file__).resolve().parents[2] / "out" / "fuzz_kernel"


def fuzz(program: Path, corpus: Path, seconds: float, seed: int) -> list[Path]:
    """Runs the program until the time is over, again after each failure; returns these."""
    failures: list[Path] = []
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0 and len(failures) < MOST_FAILURES:
        command = [program, f"{max(left, 1):.0f}", str(seed + len(failures)), corpus]
        if subprocess.run(command, env=os.environ | ENVIRONMENT).returncode == 0:
            break
        running = (corpus / "running").read_bytes()
        (size,) = struct.unpack_from("<Q", running)
        failures.append(corpus / f"failure-{time.time_ns()}")
        failures[-1].write_bytes(running[8 : 8 + size])
    return failures


def main() -> int:
    """Says what failed; 0 where nothing did."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--folder", type=Path, default=FOLDER, help="corpus and failures")
    settings = parser.parse_args()
    program = build_fuzzer(settings.folder / "build")
    failures = fuzz(program, settings.folder, settings.seconds, settings.seed)
    for failure in failures:
        sys.stdout.write(f"failed: {failure}\n")
    return bool(failures)


if __name__ == "__main__":
    sys.exit(main())
