"""The direction of imports: what makes the house testable without Blender."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
# a package of core imports only itself and earlier ones
ORDER = (
    "errors", "files", "toml", "plain", "progress", "ahead", "geometry", "pages", "cameras",
    "footage", "silhouettes", "body", "native", "energy", "rendering", "optimisers", "particles",
    "fitting", "initialisation", "motion", "take", "checking", "results", "distributed",
    "beginning", "pipeline", "performer", "bench", "cli",
)  # fmt: skip
BLENDER = frozenset(("bpy", "bmesh", "mathutils", "gpu", "bl_ui", "bpy_extras", "addon_utils"))


def imported(path: Path, root: Path) -> Iterator[tuple[int, tuple[str, ...]]]:
    """Line and dotted target of every import in ``path``, relative ones seen from ``root``."""
    package = path.relative_to(root).parent.parts
    for node in ast.walk(ast.parse(path.read_text("utf-8"), str(path))):
        if isinstance(node, ast.Import):
            for name in node.names:
                yield node.lineno, ("", *name.name.split("."))
        elif isinstance(node, ast.ImportFrom):
            base = tuple(node.module.split(".")) if node.module else ()
            above = ("",) if node.level == 0 else package[: len(package) - node.level + 1]
            for name in node.names:
                yield node.lineno, (*above, *base, name.name)


def layer(path: Path, root: Path) -> str:
    """The package (or module) of core that ``path`` belongs to."""
    return path.relative_to(root / "core").parts[0].removesuffix(".py")


def fault_of_core(path: Path, target: tuple[str, ...], root: Path) -> str | None:
    """What is wrong with this import in core; None where nothing is."""
    own = layer(path, root)
    if own == "__init__":
        return "core's own __init__ imports nothing"
    if target[0] == "":
        top = target[1]
        if top in BLENDER:
            return f"core imports {top}"
        if top in ("silhouette_mocap", "core", "addon"):
            return f"absolute import of {top}"
        return None
    if target[0] != "core":
        return f"core imports {'.'.join(target)}"
    if len(target) < 2 or target[1] not in ORDER:
        return f"{'.'.join(target)} has no place in the order"
    if ORDER.index(target[1]) > ORDER.index(own):
        return f"{own} imports {target[1]}, which comes later"
    return None


def fault_of_addon(target: tuple[str, ...]) -> str | None:
    """What is wrong with this import in the add-on; None where nothing is."""
    absolute = target[0] == "" and target[1] in ("silhouette_mocap", "core", "addon", "bl_ext")
    return f"absolute import of {target[1]}" if absolute else None


def faults(root: Path) -> list[str]:
    """One line for every import under ``root`` that goes the wrong way."""
    found = []
    for path in sorted([*root.glob("core/**/*.py"), *root.glob("addon/**/*.py")]):
        place = path.relative_to(root)
        in_core = place.parts[0] == "core"
        if in_core and layer(path, root) not in (*ORDER, "__init__"):
            found.append(f"{place}: {layer(path, root)} has no place in the order")
            continue
        for line, target in imported(path, root):
            fault = fault_of_core(path, target, root) if in_core else fault_of_addon(target)
            if fault:
                found.append(f"{place}:{line}: {fault}")
    return found


def test_imports_go_one_way():
    assert not faults(ROOT), "\n".join(faults(ROOT))


@pytest.mark.parametrize(
    ("file", "line", "fault"),
    [
        ("core/cameras/planted.py", "import bpy", "core imports bpy"),
        ("core/cameras/planted.py", "def f():\n    from mathutils import Vector", "mathutils"),
        ("core/cameras/planted.py", "from ...addon import bridge", "core imports addon.bridge"),
        ("core/cameras/planted.py", "from ..fitting.tracking import track", "which comes later"),
        ("core/cameras/planted.py", "from .. import pipeline", "which comes later"),
        ("core/cameras/planted.py", "from silhouette_mocap.core import errors", "absolute"),
        ("core/cameras/planted.py", "from ..nowhere import x", "no place in the order"),
        ("core/unlisted/planted.py", "import numpy", "no place in the order"),
        ("addon/bridge/planted.py", "import silhouette_mocap.core.errors", "absolute"),
    ],
)
def test_a_planted_violation_is_seen(tmp_path, file, line, fault):
    planted = tmp_path / file
    planted.parent.mkdir(parents=True)
    planted.write_text(line + "\n", "utf-8")
    found = faults(tmp_path)
    assert len(found) == 1 and fault in found[0], found


@pytest.mark.parametrize(
    ("file", "line"),
    [
        ("core/cameras/planted.py", "from ..geometry.arrays import frozen_array"),
        ("core/cameras/readers/planted.py", "from ..camera import Camera\nimport cv2"),
        ("core/cli/planted.py", "from ..pipeline import fit"),
        ("addon/bridge/planted.py", "import bpy\nfrom ...core.errors import MocapError"),
    ],
)
def test_an_import_of_an_earlier_package_passes(tmp_path, file, line):
    planted = tmp_path / file
    planted.parent.mkdir(parents=True)
    planted.write_text(line + "\n", "utf-8")
    assert not faults(tmp_path)
