"""The kernel as gcc compiles it under sanitizers, for `fuzz_kernel` and `sanitize_kernel`.

Its sources put red zones between the parts of their scratch where they are compiled so.
"""

import os
import subprocess
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from silhouette_mocap.core.native import build

FUZZER = Path(__file__).resolve().parent / "kernel"
SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize-recover=undefined")
PLAIN = ("-O1", "-g", "-std=gnu11", "-ffp-contract=off", "-fno-math-errno", "-fPIC")
ENVIRONMENT = {
    # what is not written must not look like zeros
    "ASAN_OPTIONS": "detect_leaks=0:quarantine_size_mb=4:max_malloc_fill_size=1000000000",
    "UBSAN_OPTIONS": "print_stacktrace=1",
}


def _compile(command: Sequence[str]) -> None:
    subprocess.run(["gcc", "-Wno-unknown-pragmas", *command], check=True)


def kernel_objects(folder: Path, flags: Sequence[str]) -> list[str]:
    """Compiles the kernel's sources, each once per code path; returns the objects' paths."""
    mark = f'-DSM_FINGERPRINT="{build.fingerprint()}"'
    commands, objects = [], []
    for name, source, own in build._objects(build.host_target()):
        own = [f.replace("-mcpu=x86_64_", "-march=x86-64-") for f in own if "-vector-" not in f]
        objects.append(str(folder / name))
        source = str(build.SOURCES / source)
        commands.append([*PLAIN, *flags, *own, mark, "-c", source, "-o", objects[-1]])
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(_compile, commands))
    return objects


def build_library(folder: Path, flags: Sequence[str] = SANITIZERS) -> Path:
    """The library, under the name by which it is looked for, in ``folder``."""
    library = folder / build.library_name(build.host_target())
    _compile([*flags, "-shared", "-o", str(library), *kernel_objects(folder, flags), "-lm"])
    return library


def build_fuzzer(folder: Path, flags: Sequence[str] = SANITIZERS) -> Path:
    """The fuzzer as a program in ``folder``, with the kernel and calls back from its places."""
    folder.mkdir(parents=True, exist_ok=True)
    program = folder / "fuzz"
    objects = kernel_objects(folder, [*flags, "-fsanitize-coverage=trace-pc"])
    sources = [str(path) for path in sorted(FUZZER.glob("*.c"))]
    include = ["-O2", "-g", "-std=gnu11", "-Wall", "-Wextra", f"-I{build.SOURCES}"]
    _compile([*include, *flags[:1], "-o", str(program), *sources, *objects, "-lm"])
    return program
