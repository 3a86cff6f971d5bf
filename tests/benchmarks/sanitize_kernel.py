"""The kernel's tests with the kernel under AddressSanitizer and UBSan, and under valgrind.

    cd tests && python -m benchmarks.sanitize_kernel [asan] [valgrind] [-- PYTEST ARGUMENTS]

A copy of the package gets a library that gcc has compiled so; the tests then run as ever. valgrind
knows no AVX-512, so that the kernel takes its lower code paths there; it watches what the
sanitizers do not, numbers that nobody has written. What it says of numpy and Python is left out.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from benchmarks.sanitized import ENVIRONMENT, build_library
from silhouette_mocap.core.native.build import SOURCES

ROOT = Path(__file__).resolve().parents[2]
TESTS = [
    f"tests/core/rendering/test_{name}.py"
    for name in (
        *("native_evaluator", "closed_surfaces", "skinned_surfaces", "edge_records", "outline"),
        *("invariants", "invariants_meshes"),
    )
]
TESTS += ["tests/core/native", "tests/core/fitting/test_contour_targets.py"]
TESTS += ["tests/core/fitting/test_twists.py"]
FEW = "every_side or triangles_apart or another_order or fixed_otherwise or more_crossings"
"""Tests enough for valgrind, which takes fifty times as long."""


def copied_package(folder: Path, flags: Sequence[str]) -> Path:
    """A folder to import the package from, its kernel compiled with the flags."""
    package = folder / "silhouette_mocap"
    shutil.copytree(ROOT / "core", package / "core", ignore=shutil.ignore_patterns("*.so"))
    shutil.copy(ROOT / "__init__.py", package)
    build_library(package / "core" / "native", flags)
    return folder


def run_tests(folder: Path, environment: dict[str, str], command: Sequence[str]) -> int:
    """Runs pytest with the package from the folder; returns its exit code."""
    places = os.pathsep.join([str(folder), str(ROOT / "tests"), str(ROOT / "tests" / "command")])
    environment = os.environ | {"PYTHONPATH": places, "PYTHONMALLOC": "malloc"} | environment
    return subprocess.run(command, cwd=ROOT, env=environment).returncode


def under_sanitizers(arguments: Sequence[str]) -> int:
    """The first finding ends the process."""
    libraries = [
        subprocess.check_output(["gcc", f"-print-file-name={name}"], text=True).strip()
        for name in ("libasan.so", "libubsan.so")
    ]
    flags = "-fsanitize=address,undefined", "-fno-sanitize-recover=undefined"
    with tempfile.TemporaryDirectory() as folder:
        package = copied_package(Path(folder), flags)
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-s"]
        environment = ENVIRONMENT | {"LD_PRELOAD": " ".join(libraries)}
        return run_tests(package, environment, [*command, *(arguments or TESTS)])


def findings(log: str, names: Sequence[str]) -> list[str]:
    """The errors in valgrind's log at places in the named sources."""
    place = re.compile("|".join(rf"\({re.escape(name)}:\d+\)" for name in names))
    blocks = re.split(r"^==\d+== $", log, flags=re.MULTILINE)
    return [block for block in blocks if place.search(block)]


def under_valgrind(arguments: Sequence[str]) -> int:
    """Number of findings in the kernel, or of tests that fail."""
    names = [path.name for path in (*SOURCES.glob("*.c"), *SOURCES.glob("*.h"))]
    with tempfile.TemporaryDirectory() as folder:
        package, log = copied_package(Path(folder), []), Path(folder) / "log"
        command = ["valgrind", "-q", f"--log-file={log}", sys.executable, "-m", "pytest"]
        command += ["-q", "-p", "no:cacheprovider", *(arguments or [*TESTS, "-k", FEW])]
        code = run_tests(package, {}, command)
        found = findings(log.read_text(errors="replace"), names)
    for block in found:
        sys.stdout.write(block)
    sys.stdout.write(f"valgrind: {len(found)} findings in the kernel\n")
    return code or len(found)


def main() -> int:
    """0 where nothing was found."""
    given = sys.argv[1:]
    cut = given.index("--") if "--" in given else len(given)
    runs = {"asan": under_sanitizers, "valgrind": under_valgrind}
    chosen = given[:cut] or list(runs)
    return int(any([runs[name](given[cut + 1 :]) for name in chosen]))


if __name__ == "__main__":
    sys.exit(main())
