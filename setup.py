"""Builds the native kernel and tags the wheel; everything else stands in pyproject.toml.

The repository's root is the package ``silhouette_mocap``. The kernel is compiled into the checkout
for an editable install, else into the wheel, which is tagged ``py3-none-<platform>``: the library
is loaded by ctypes and knows no Python. ``SILHOUETTE_MOCAP_TARGET`` selects another platform.
"""

import shutil
import sys
from pathlib import Path

from setuptools import Distribution, find_packages, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_py import build_py

ROOT = Path(__file__).resolve().parent
NAME = "silhouette_mocap"
sys.path.insert(0, str(ROOT / "core" / "native"))
import build as kernel  # noqa: E402

sys.path.pop(0)


class BuildPy(build_py):
    """Python files and the native library."""

    def find_package_modules(self, package, package_dir):
        """Of the root only the package's own two files: not this script, no helper beside it."""
        modules = super().find_package_modules(package, package_dir)
        return [m for m in modules if package != NAME or m[1] in ("__init__", "__main__")]

    def run(self):
        """Builds; first clears what an earlier build for another platform left behind."""
        if not self.editable_mode:
            shutil.rmtree(self.build_lib, ignore_errors=True)
        super().run()
        folder = self._library().parent
        folder.mkdir(parents=True, exist_ok=True)
        kernel.build(kernel.host_target(), folder)

    def get_outputs(self, include_bytecode=True):
        """The files built, the library among them."""
        outputs = super().get_outputs(include_bytecode)
        return outputs if self.editable_mode else [*outputs, str(self._library())]

    def _library(self) -> Path:
        package = ROOT if self.editable_mode else Path(self.build_lib) / NAME
        return package / "core" / "native" / kernel.library_name(kernel.host_target())


class BdistWheel(bdist_wheel):
    """A wheel of one platform and any Python."""

    def get_tag(self):
        """The tag ``py3-none-<platform>``."""
        return "py3", "none", kernel.wheel_platform(kernel.host_target())


class BinaryDistribution(Distribution):
    """A distribution that belongs to one platform."""

    def has_ext_modules(self):
        """True: the library goes where platform-dependent files go."""
        return True


setup(
    packages=[
        NAME,
        *(f"{NAME}.{top}" for top in ("core", "addon")),
        *(f"{NAME}.{top}.{name}" for top in ("core", "addon") for name in find_packages(top)),
    ],
    package_data={
        NAME: ["blender_manifest.toml"],
        f"{NAME}.core.native": ["*.c", "*.h"],
        f"{NAME}.core.pages": ["*.css", "*.js"],
    },
    cmdclass={"build_py": BuildPy, "bdist_wheel": BdistWheel},
    distclass=BinaryDistribution,
)
