"""The performer of the sample: a skeleton of its own and flesh made of blended round cones.

Space: metres, Z up; in the rest pose the performer looks along -Y, the left hand at +X, the arms
hang straight down, and every bone's axes are parallel to the world's. The flesh is the zero set of
a signed distance: each segment is a few round cones (the hull of two balls), flattened where the
body is flat, and neighbours melt into each other by a polynomial smooth minimum, so that no joint
shows a seam. A limb melts into the trunk only around its shoulder or hip: a hand that passes the
thigh does not stick to it.

Lengths and girths start from the usual adult proportions of a stature of 1.72 m; then every bone
is drawn up to 5 % longer or shorter and every segment 10 to 20 % thicker or thinner, left as right.
"""

from dataclasses import dataclass

import numpy as np

SEED = 23
SIDES = ("left", "right")

# bone, parent, offset from the parent's joint at the left side
BONES = (
    ("pelvis", None, (0.0, 0.0, 0.0)),
    ("lumbar", "pelvis", (0.0, 0.020, 0.100)),
    ("waist", "lumbar", (0.0, -0.005, 0.130)),
    ("chest", "waist", (0.0, 0.010, 0.140)),
    ("neck", "chest", (0.0, 0.012, 0.155)),
    ("head", "neck", (0.0, -0.018, 0.092)),
    ("clavicle", "chest", (0.020, -0.025, 0.108)),
    ("upper_arm", "clavicle", (0.156, 0.024, -0.014)),
    ("forearm", "upper_arm", (0.0, 0.0, -0.305)),
    ("hand", "forearm", (0.0, 0.0, -0.255)),
    ("thigh", "pelvis", (0.088, 0.0, 0.0)),
    ("shank", "thigh", (0.0, 0.0, -0.420)),
    ("foot", "shank", (0.0, 0.0, -0.415)),
    ("toes", "foot", (0.0, -0.128, -0.052)),
)
WHOLE = ("trunk", "head")
CENTRAL = ("pelvis", "lumbar", "waist", "chest", "neck", "head")

# bone, from, to (left side, at average length), radii, axis and factor of flattening, material
FLESH = {
    "trunk": (
        ("pelvis", (-0.072, 0.002, 0.030), (0.072, 0.002, 0.030), 0.098, 0.098, "y1.0", "trousers"),
        ("pelvis", (-0.066, 0.048, -0.03), (0.066, 0.048, -0.03), 0.082, 0.082, "y1.0", "trousers"),
        ("lumbar", (-0.050, -0.028, 0.045), (0.050, -0.028, 0.045), 0.096, 0.096, "y1.0", "shirt"),
        ("waist", (-0.058, -0.014, 0.040), (0.058, -0.014, 0.040), 0.096, 0.096, "y1.0", "shirt"),
        ("chest", (-0.068, -0.012, 0.010), (0.068, -0.012, 0.010), 0.098, 0.098, "y1.0", "shirt"),
        ("chest", (-0.090, 0.005, 0.085), (0.090, 0.005, 0.085), 0.074, 0.074, "y1.0", "shirt"),
    ),
    "head": (
        ("neck", (0.0, 0.010, -0.045), (0.0, -0.002, 0.050), 0.066, 0.055, "y1.0", "skin"),
        ("head", (0.0, -0.020, 0.020), (0.0, -0.060, -0.012), 0.062, 0.038, "x0.9", "skin"),
        ("head", (0.0, 0.022, 0.098), (0.0, -0.024, 0.106), 0.090, 0.080, "x0.84", "hair"),
        ("head", (0.0, -0.056, 0.076), (0.0, -0.064, 0.008), 0.060, 0.044, "x0.9", "skin"),
        ("head", (0.0, -0.112, 0.068), (0.0, -0.122, 0.042), 0.007, 0.011, "y1.0", "skin"),
    ),
    "girdle": (
        ("clavicle", (-0.020, 0.034, 0.036), (0.128, 0.024, -0.022), 0.044, 0.042, "y1.0", "shirt"),
        ("clavicle", (0.050, -0.030, -0.050), (0.118, 0.002, -0.05), 0.050, 0.046, "y1.0", "shirt"),
    ),
    "arm": (
        ("upper_arm", (0.000, 0.0, -0.012), (0.003, 0.003, -0.085), 0.052, 0.053, "y1.0", "shirt"),
        ("upper_arm", (0.0, -0.008, -0.090), (0.0, -0.002, -0.290), 0.049, 0.038, "y1.0", "shirt"),
        ("forearm", (0.0, 0.0, -0.005), (0.0, -0.006, -0.070), 0.037, 0.043, "y1.0", "skin"),
        ("forearm", (0.0, -0.004, -0.080), (0.0, 0.0, -0.245), 0.041, 0.028, "y1.0", "skin"),
    ),
    "hand": (
        ("hand", (0.0, -0.002, -0.020), (0.0, -0.006, -0.082), 0.033, 0.044, "x0.48", "skin"),
        ("hand", (0.0, -0.006, -0.090), (-0.014, -0.006, -0.165), 0.040, 0.026, "x0.42", "skin"),
        ("hand", (-0.006, -0.026, -0.035), (-0.016, -0.060, -0.090), 0.017, 0.012, "y1.0", "skin"),
    ),
    "leg": (
        ("thigh", (0.004, 0.008, -0.010), (0.0, -0.010, -0.170), 0.092, 0.080, "y1.0", "trousers"),
        ("thigh", (0.000, -0.012, -0.170), (0.0, -0.006, -0.400), 0.080, 0.056, "y1.0", "trousers"),
        ("shank", (0.0, -0.004, -0.010), (0.0, 0.012, -0.110), 0.054, 0.056, "y1.0", "trousers"),
        ("shank", (0.0, 0.015, -0.120), (0.0, 0.004, -0.390), 0.057, 0.036, "y1.0", "trousers"),
    ),
    "foot": (
        ("foot", (0.0, 0.044, -0.044), (0.0, -0.010, -0.028), 0.036, 0.042, "y1.0", "shoes"),
        ("foot", (0.0, 0.000, -0.022), (0.004, -0.115, -0.050), 0.042, 0.046, "z0.70", "shoes"),
        ("foot", (0.0, 0.040, -0.054), (0.004, -0.120, -0.054), 0.032, 0.047, "z0.52", "shoes"),
        ("toes", (0.002, 0.0, -0.003), (0.000, -0.058, -0.006), 0.046, 0.034, "z0.52", "shoes"),
    ),
}  # fmt: skip
# group -> width of the smooth minimum within it, and where (bone) and how wide it joins the rest, m
BLENDS = {
    "trunk": (0.085, None, 0.0),
    "head": (0.024, "neck", 0.05),
    "girdle": (0.05, "clavicle", 0.05),
    "arm": (0.035, "upper_arm", 0.05),
    "hand": (0.014, "hand", 0.025),
    "leg": (0.045, "thigh", 0.05),
    "foot": (0.018, "foot", 0.03),
}
MATERIALS = ("skin", "hair", "shirt", "trousers", "shoes")


def sided(bone: str, side: str) -> str:
    """Name of a bone on a side; the central ones have none."""
    return bone if bone in CENTRAL else f"{side}_{bone}"


@dataclass(frozen=True, eq=False)
class Performer:
    """The individual: its skeleton and its flesh at rest.

    Attributes:
        bones: names, parents before children.
        parents: name -> name of the parent; None for the pelvis.
        offsets: name -> (3,) position in the parent's space, m.
        ankle_height: of the ankle's centre over the sole, m.
        flesh: (K,) records with group, bone, ends (2, 3), radii (2,), normal (3,), squeeze
            and material.
    """

    bones: tuple[str, ...]
    parents: dict[str, str | None]
    offsets: dict[str, np.ndarray]
    ankle_height: float
    flesh: np.ndarray


FLESH_TYPE = np.dtype(
    [
        ("group", "U12"),
        ("bone", "U16"),
        ("ends", float, (2, 3)),
        ("radii", float, (2,)),
        ("normal", float, (3,)),
        ("squeeze", float),
        ("material", int),
    ]
)


def _piece(row, group: str, side: str, length: float, girth: float) -> tuple:
    """One record of flesh, mirrored for the right side."""
    bone, start, end, *radii, squeeze, material = row
    mirror = np.array([-1.0 if side == "right" else 1.0, 1.0, 1.0])
    ends = np.array([start, end]) * mirror * length
    axis = ends[1] - ends[0]
    normal = np.eye(3)["xyz".index(squeeze[0])]
    normal = normal - axis * (normal @ axis) / (axis @ axis) if squeeze[1:] != "1.0" else normal
    normal = normal / np.linalg.norm(normal)
    name = group if group in WHOLE else f"{side}_{group}"
    radii = np.array(radii) * girth
    return name, sided(bone, side), ends, radii, normal, squeeze[1:], MATERIALS.index(material)


def make_performer(seed: int = SEED) -> Performer:
    """The performer drawn with ``seed``."""
    rng = np.random.default_rng(seed)
    names = [row[0] for row in BONES]
    length = dict(zip(names, rng.uniform(0.95, 1.05, len(names)), strict=True))
    change = rng.uniform(0.10, 0.20, len(names)) * rng.choice((-1.0, 1.0), len(names))
    girth = dict(zip(names, 1.0 + change, strict=True))
    bones, parents, offsets = [], {}, {}
    for bone, parent, offset in BONES:
        for side in SIDES[: 1 if bone in CENTRAL else 2]:
            name = sided(bone, side)
            bones.append(name)
            parents[name] = None if parent is None else sided(parent, side)
            mirror = np.array([-1.0 if side == "right" else 1.0, 1.0, 1.0])
            offsets[name] = np.array(offset) * mirror * length[bone if parent is None else parent]
    flesh = [
        _piece(row, group, side, length[row[0]], girth[row[0]])
        for group, rows in FLESH.items()
        for side in SIDES[: 1 if group in WHOLE else 2]
        for row in rows
    ]
    table = np.array(flesh, FLESH_TYPE)
    return Performer(tuple(bones), parents, offsets, _ankle_height(table, offsets), table)


def _ankle_height(flesh: np.ndarray, offsets: dict[str, np.ndarray]) -> float:
    """How far the sole lies below the ankle when the foot is flat, m."""
    foot, toes = (flesh[flesh["bone"] == f"left_{bone}"] for bone in ("foot", "toes"))
    lowest = []
    for part in (foot, toes):
        level = part["normal"][:, 2] > 0.5
        thickness = part["radii"] * np.where(level, part["squeeze"], 1.0)[:, None]
        lowest.append((part["ends"][:, :, 2] - thickness).min())
    return -float(min(lowest[0], lowest[1] + offsets["left_toes"][2]))
