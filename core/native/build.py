"""Compiles the native kernel with zig, for this machine or across; standard library only.

Run ``python core/native/build.py [TARGET] [FOLDER]`` after ``pip install ziglang``. What draws is
compiled once per code path; contraction is off, so that all paths give the same
bits. The library carries a fingerprint of its sources, by which a stale one is recognised.
"""

import hashlib
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCES = Path(__file__).resolve().parent
TARGETS = {  # ours: (zig's name, wheel platform, suffix of the library)
    "linux-x86_64": (
        "x86_64-linux-gnu.2.17",
        "manylinux_2_17_x86_64.manylinux2014_x86_64",
        ".so",
    ),
    "windows-x86_64": ("x86_64-windows-gnu", "win_amd64", ".dll"),
    "windows-arm64": ("aarch64-windows-gnu", "win_arm64", ".dll"),
    "macos-arm64": ("aarch64-macos.11.0", "macosx_11_0_arm64", ".dylib"),
    "macos-x86_64": ("x86_64-macos.10.13", "macosx_10_13_x86_64", ".dylib"),
}
FLAGS = ("-O3", "-std=c11", "-Wall", "-Wextra", "-ffp-contract=off", "-fno-sanitize=undefined",
         "-fno-math-errno", "-fvisibility=hidden", "-s", "-g0")  # fmt: skip
PATHS = {
    "base": (),
    "v3": ("-mcpu=x86_64_v3",),
    "v4": ("-mcpu=x86_64_v4", "-mprefer-vector-width=512"),
}


def host_target() -> str:
    """The target of this machine, or ``SILHOUETTE_MOCAP_TARGET`` from the environment."""
    machine = platform.machine().lower()
    machine = {"amd64": "x86_64", "aarch64": "arm64"}.get(machine, machine)
    system = {"win32": "windows", "darwin": "macos"}.get(sys.platform, sys.platform)
    return os.environ.get("SILHOUETTE_MOCAP_TARGET", f"{system}-{machine}")


def library_name(target: str) -> str:
    """The library's file name; it names the target, so that targets can lie side by side.

    Raises:
        SystemExit: the target is none of `TARGETS`.
    """
    if target not in TARGETS:
        raise SystemExit(f"no native kernel for {target}; known: {', '.join(TARGETS)}")
    return f"kernel-{target}{TARGETS[target][2]}"


def wheel_platform(target: str) -> str:
    """The platform tag of a wheel for the target."""
    return TARGETS[target][1]


def fingerprint(folder: Path = SOURCES) -> str:
    """A digest of the kernel's sources, whatever their line ends; empty where there are none."""
    files = sorted([*folder.glob("*.c"), *folder.glob("*.h")], key=lambda path: path.name)
    if not files:
        return ""
    digest = hashlib.sha256()
    for path in files:
        digest.update(path.name.encode() + b"\0" + path.read_bytes().replace(b"\r\n", b"\n"))
    return digest.hexdigest()[:16]


def _objects(target: str) -> list[tuple[str, str, tuple[str, ...]]]:
    """(object, source, flags) of everything that is linked."""
    paths = PATHS if "x86_64" in target else {"base": ()}
    whole: list[tuple[str, str, tuple[str, ...]]] = [
        (f"{name}.o", f"{name}.c", ()) for name in ("kernel", "processor", "transforms", "weights")
    ]
    return whole + [
        (f"{name}_{path}.o", f"{name}.c", (f"-DSM_PATH={path}", *flags))
        for path, flags in paths.items()
        for name in ("coverage", "closed", "contours", "outline", "skin", "terms", "triangles")
    ]


def build(target: str | None = None, folder: Path = SOURCES) -> Path:
    """Compiles the library for ``target`` into ``folder`` and returns its path.

    A library that stands there is replaced in one step; processes that use it go on.

    Raises:
        SystemExit: unknown target.
        CalledProcessError: the compiler failed.
    """
    target = target or host_target()
    name = library_name(target)
    zig = TARGETS[target][0]
    compiler = [sys.executable, "-m", "ziglang", "cc", "-target", zig, *FLAGS]
    if "windows" not in target:
        compiler.append("-fPIC")
    with tempfile.TemporaryDirectory() as scratch:
        objects = _objects(target)
        for output, source, flags in objects:
            mark = f'-DSM_FINGERPRINT="{fingerprint()}"'
            command = [*compiler, *flags, mark, "-c", str(SOURCES / source), "-o", output]
            subprocess.run(command, check=True, cwd=scratch)
        link = [f"-Wl,-install_name,@rpath/{name}"] if "macos" in target else []
        command = [*compiler, "-shared", "-o", name, *(output for output, *_ in objects), *link]
        subprocess.run([*command, "-lm"], check=True, cwd=scratch)
        part = Path(folder) / f"{name}.{os.getpid()}.part"
        part.write_bytes((Path(scratch) / name).read_bytes())
    library = Path(folder) / name
    os.replace(part, library)
    return library


if __name__ == "__main__":
    chosen = sys.argv[1] if len(sys.argv) > 1 else None
    sys.stdout.write(f"{build(chosen, *(Path(place) for place in sys.argv[2:3]))}\n")
