"""Faults of what `clean` is given."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
from circumstances import ON_UNIX, hardly_any_space
from faults import Chapter, Words, replace_text
from moving import motion_with
from silhouette_mocap.core.body.file import write_body
from silhouette_mocap.core.body.scaling import scaled
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.motion.motion import Motion, read_motion, write_motion
from silhouette_mocap.core.results.folder import occupied

CLEANING = Chapter("Cleaning")
BODY = template("sixteen_segment")


def fitted(folder: Path) -> Path:
    """A folder beside the take's that looks like that of a finished fit."""
    out = folder.parent / "out"
    out.mkdir()
    write_motion(out / "motion.npz", motion_with(BODY, np.zeros((9, len(BODY.dofs)))))
    write_body(out / "body.npz", BODY)
    report = {"take": "small", "inputs": {"floor": "0.0"}, "digests": {}}
    (out / "report.json").write_text(json.dumps(report), "utf-8")
    return out


def clean_words(out: Path, *more: str) -> Words:
    """The words that clean what is in ``out``."""
    return ("clean", out, "--progress", "none", *more)


def change(out: Path, **values) -> Motion:
    """Puts other values into the motion in ``out``."""
    motion = replace(read_motion(out / "motion.npz"), **values)
    write_motion(out / "motion.npz", motion)
    return motion


@CLEANING.add("a folder without a motion", "out: holds no motion.npz", "give", early=False)
def _(folder: Path):
    return clean_words(folder.parent / "out")


@CLEANING.add("a motion cut short", "motion.npz: cannot be read", early=False)
def _(folder: Path):
    out = fitted(folder)
    (out / "motion.npz").write_bytes((out / "motion.npz").read_bytes()[:500])
    return clean_words(out)


@CLEANING.add("a motion that holds no numbers", "motion.npz: is a damaged motion", early=False)
def _(folder: Path):
    out = fitted(folder)
    change(out, pose_raw=np.full((9, len(BODY.dofs)), np.nan))
    return clean_words(out)


@CLEANING.add("a motion without its body", "body.npz: no such file", early=False)
def _(folder: Path):
    out = fitted(folder)
    (out / "body.npz").unlink()
    return clean_words(out)


@CLEANING.add("a motion beside another body", "of different fits; run fit again", early=False)
def _(folder: Path):
    out = fitted(folder)
    write_body(out / "body.npz", scaled(BODY, 1.1))
    return clean_words(out)


@CLEANING.add("a report cut short", "report.json: cannot be read as JSON", early=False)
def _(folder: Path):
    out = fitted(folder)
    (out / "report.json").write_text('{"take": ', "utf-8")
    return clean_words(out)


@CLEANING.add("a report that knows no floor", "report.json: does not tell", "--floor", early=False)
def _(folder: Path):
    out = fitted(folder)
    replace_text(out / "report.json", '"floor"', '"ceiling"')
    return clean_words(out)


@CLEANING.add("a floor that is nowhere", "a floor at nan m is none", "--floor 0", early=False)
def _(folder: Path):
    return clean_words(fitted(folder), "--floor", "nan")


@CLEANING.add("a motion lost all over", "all frames are lost", "fit the take again", early=False)
def _(folder: Path):
    out = fitted(folder)
    change(out, lost=np.ones(9, bool))
    return clean_words(out)


@CLEANING.add("a cut-off that the frames cannot show", "20 Hz", "15 Hz", "--smooth", early=False)
def _(folder: Path):
    return clean_words(fitted(folder), "--smooth", "20")


@CLEANING.add("a cut-off of nothing", "a cut-off of 0 is none", "--smooth 6", early=False)
def _(folder: Path):
    return clean_words(fitted(folder), "--smooth", "0")


@CLEANING.add("keys of no tolerance", "a tolerance of keys of -1 is none", "--keys 5", early=False)
def _(folder: Path):
    return clean_words(fitted(folder), "--keys", "-1")


@CLEANING.add(
    "two runs on one result",
    "out: another run writes into this folder",
    within=lambda folder: occupied(folder.parent / "out"),
    early=False,
)
def _(folder: Path):
    return clean_words(fitted(folder))


@CLEANING.add(
    "a disk too full for the clean motion",
    "out/clean.html: cannot be written",
    "free space",
    within=hardly_any_space,
    early=False,
    unless=ON_UNIX,
)
def _(folder: Path):
    return clean_words(fitted(folder))
