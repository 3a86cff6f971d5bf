import subprocess
import sys
import tomllib
from pathlib import Path

import bpy

CHECKOUT = Path(__file__).resolve().parents[2]


def test_blender_accepts_the_manifest():
    scripts = Path(bpy.utils.system_resource("SCRIPTS"))
    tool = scripts / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py"
    done = subprocess.run(
        [sys.executable, tool, "validate", CHECKOUT], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Success" in done.stdout


def test_the_extension_and_the_package_have_one_version():
    manifest = tomllib.loads((CHECKOUT / "blender_manifest.toml").read_text())
    package = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())
    assert manifest["version"] == package["project"]["version"]
