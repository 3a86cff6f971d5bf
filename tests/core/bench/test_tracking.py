"""The benchmark of tracking on takes so small that it is done in seconds."""

import json
from dataclasses import replace

import numpy as np
import pytest
from known_recording import known_poses, known_recording
from silhouette_mocap.core.bench import tracking, tracking_speed, tracking_takes, tracking_trials
from silhouette_mocap.core.bench.disturbances.failing_cameras import DeadCamera
from silhouette_mocap.core.bench.disturbances.ladder import noise_ladder, torments
from silhouette_mocap.core.bench.disturbances.recording import Only, disturbed
from silhouette_mocap.core.bench.tracking_plots import PLOTS
from silhouette_mocap.core.bench.tracking_runs import tracked
from silhouette_mocap.core.bench.tracking_speed import same_bits, threaded
from silhouette_mocap.core.bench.tracking_stages import STAGES
from silhouette_mocap.core.bench.tracking_takes import Beginning
from silhouette_mocap.core.bench.tracking_trials import TrialSettings
from silhouette_mocap.core.bench.tracking_variants import (
    DEFAULT,
    HELD,
    HIERARCHICAL,
    ablations,
)
from silhouette_mocap.core.cli import main
from small_take import known_start
from synthetic import small_body

SECTIONS = ("takes", "torments", "ablation", "noise_ladder", "number_of_cameras", "frame_rate")


def short(frames):
    recording = known_recording()
    return replace(recording, frames=recording.frames[frames])


def start_at(frame):
    return Beginning(small_body("sixteen_segment"), known_poses()[frame], frame)


@pytest.mark.parametrize(("variant", "frames"), [(DEFAULT, 4), (HIERARCHICAL, 1)])
def test_one_and_two_threads_find_the_same_bits(variant, frames):
    recording, start = short(slice(1, 1 + frames)), start_at(0)
    one, two = (
        tracked(recording, start, variant, lambda frame: None, threaded(count)) for count in (1, 2)
    )
    assert same_bits(one, two)
    # of a pixel of 33 mm, on silhouettes without noise
    assert one.score.absolute.mean < 33
    two.motion.pose[-1, -1] += 1e-15
    assert not same_bits(one, two)


def test_a_take_is_tracked_forward_and_backward_from_its_initial_pose():
    order = []
    found = tracked(short(slice(2, 7)), start_at(4), DEFAULT, order.append)
    assert order == [4, 5, 6, 3, 2]
    assert found.motion.frames.tolist() == [2, 3, 4, 5, 6]
    assert found.errors.shape == (5, 14) and found.score.absolute.mean < 33


@pytest.mark.parametrize("variant", [DEFAULT, replace(DEFAULT, second_look=False)])
def test_what_is_in_doubt_is_looked_at_again_unless_that_is_off(variant):
    dark, read = disturbed(known_recording(), 0, Only(DeadCamera(), (3, 4))), []

    def look(frame, view):
        read.append(frame)
        return dark.look(frame, view)

    tracked(replace(dark, look=look), start_at(0), variant, lambda frame: None)
    assert read.count(9) == len(dark.cameras)
    assert (read.count(4) > len(dark.cameras)) == variant.second_look


def test_to_hold_the_first_pose_is_as_wrong_as_the_performer_moves():
    found = tracked(short(slice(0, 5)), start_at(0), HELD, lambda frame: None)
    points = known_recording().truth.points[:5]
    moved = 1000 * np.linalg.norm(points - points[0], axis=2)
    assert found.errors == pytest.approx(moved)


@pytest.fixture
def few_trials(monkeypatch, quick_start):
    """Little noise, nothing that takes long, no OpenGL, and the first pose known."""
    monkeypatch.setattr(tracking_takes, "initialised", known_start)
    monkeypatch.setattr(tracking_speed, "_paper", threaded(1))
    monkeypatch.setattr(tracking_speed, "BASELINE", HELD)
    monkeypatch.setattr(tracking_speed, "HIERARCHICAL", HELD)
    kinds = ("erosion", "calibration, angle")
    monkeypatch.setattr(
        tracking_trials,
        "noise_ladder",
        lambda *given: [rung for rung in noise_ladder(*given) if rung.kind in kinds],
    )
    monkeypatch.setattr(tracking_trials, "BASELINES", (HELD,))
    monkeypatch.setattr(tracking_trials, "torments", lambda *given: torments(*given)[::4])
    monkeypatch.setattr(tracking_trials, "ablations", lambda: ablations()[:1])
    trials = TrialSettings(3, places=(0.5,), levels=(1,), camera_counts=(3,), steps=(2,))
    settings = tracking.TrackingSettings(trials=trials, speed=tracking_speed.SpeedSettings(2, 1, 1))
    monkeypatch.setattr(tracking, "QUICK", settings)


def test_the_command_measures_everything_and_writes_it(few_trials, small_take, tmp_path, capsys):
    file = tmp_path / "new" / "tracking.json"
    words = ["bench", "tracking", str(small_take), "--quick", "--json", str(file)]
    assert main([*words, "--out", str(tmp_path)]) == 0
    shown = capsys.readouterr()
    assert "track small" in shown.err and "speed of small" in shown.err
    found = json.loads(file.read_text("utf-8"))
    assert found["faults"] == []
    for section in SECTIONS:
        rows = found[section]
        assert rows and all(row["mm_per_px"] > 20 for row in rows), section
        if section != "torments":
            errors = [row["absolute_mm"] for row in rows]
            assert errors == sorted(errors, reverse=True), section
    assert {row["name"] for row in found["takes"]} == {DEFAULT.name, HELD.name}
    assert {row["name"] for row in found["noise_ladder"]} == {"erosion", "calibration, angle"}
    assert [row["cameras"] for row in found["number_of_cameras"]] == [3]
    assert found["frame_rate"][0]["frames"] == 2
    assert found["speed"]["same_bits"] and set(found["speed"]["stages"]) == set(STAGES)
    assert sum(found["speed"]["shares"].values()) == pytest.approx(1, abs=1e-4)
    assert set(found["confidence"]) == {"undisturbed", "tormented", "noisy", "all of these"}
    for name in ("tracking.md", "tracking_readme.md", *(f"{plot}.svg" for plot in PLOTS)):
        assert str(tmp_path / name) in shown.out and (tmp_path / name).is_file()
