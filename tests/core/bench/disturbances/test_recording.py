"""What all disturbances have in common, and where they are limited to."""

from dataclasses import replace

import numpy as np
import pytest
from known_recording import FRAMES, known_recording
from silhouette_mocap.core.bench.disturbances.failing_cameras import DeadCamera
from silhouette_mocap.core.bench.disturbances.ladder import LEVELS, noise_ladder, some, torments
from silhouette_mocap.core.bench.disturbances.recording import Only, disturbed

RECORDING = known_recording()
RUNGS = noise_ladder(RECORDING, initial=1)
RANDOM = {"boundary jitter", "holes", "limb dropout", "speckle"}


def bits(recording, order):
    """Frame and view to the picture's bytes, asked for in this order."""
    found = {}
    for frame in order:
        for view, seen in enumerate(recording.silhouettes(frame)):
            found[frame, view] = seen.foreground.tobytes(), seen.observed.tobytes()
    return found


@pytest.mark.parametrize("rung", RUNGS, ids=lambda rung: f"{rung.kind}-{rung.level}")
def test_a_seed_gives_the_same_bits_in_whatever_order_frames_are_asked_for(rung):
    once, again, other = (disturbed(RECORDING, seed, *rung.disturbances) for seed in (3, 3, 4))
    frames = once.frames[2:9:3]
    assert bits(once, frames) == bits(again, reversed(frames))
    for one, same in zip(once.cameras, again.cameras, strict=True):
        assert np.array_equal(one.projection, same.projection)
    if rung.kind in RANDOM and rung.level == LEVELS:
        assert bits(once, frames) != bits(other, frames)


def test_every_kind_of_noise_has_all_levels_and_does_something():
    kinds = {rung.kind for rung in RUNGS}
    assert {(rung.kind, rung.level) for rung in RUNGS} == {
        (kind, level) for kind in kinds for level in range(1, LEVELS + 1)
    }
    clean = bits(RECORDING, (4, 6))
    for rung in RUNGS:
        noisy = disturbed(RECORDING, 0, *rung.disturbances)
        if rung.level == LEVELS and noisy.cameras == RECORDING.cameras:
            assert bits(noisy, (4, 6)) != clean, rung.kind


def test_a_limited_disturbance_changes_nothing_elsewhere():
    limited = disturbed(RECORDING, 0, Only(DeadCamera(), (3, 5), (1,)))
    clean, found = (bits(r, r.frames) for r in (RECORDING, limited))
    changed = {place for place in clean if clean[place] != found[place]}
    assert changed == {(3, 1), (4, 1), (5, 1)}


@pytest.mark.parametrize("number", [0, 1])
def test_torments_stay_within_their_frames_and_leave_some_after(number):
    clean = bits(RECORDING, RECORDING.frames)
    for torment in torments(RECORDING, 0.3, number):
        first, last = torment.frames
        assert 0 < first <= last < FRAMES - 3
        tormented = disturbed(RECORDING, 0, torment.disturbance)
        found = bits(tormented, tormented.frames)
        changed = {frame for frame, view in found if found[frame, view] != clean[frame, view]}
        gone = set(RECORDING.frames) - set(tormented.frames)
        assert changed | gone, torment.name
        assert all(first <= frame <= last for frame in changed | gone), torment.name


def test_noise_of_one_camera_leaves_the_others_alone():
    for rung in RUNGS:
        if rung.kind in ("one camera late", "one camera early", "occluder"):
            noisy = disturbed(RECORDING, 0, *rung.disturbances)
            clean, found = (bits(r, (2, 4)) for r in (RECORDING, noisy))
            changed = {view for frame, view in clean if clean[frame, view] != found[frame, view]}
            assert len(changed) == 1


def test_one_camera_is_always_left():
    assert some(8, 3) == (0, 2, 5)
    assert some(2, 3) == (0,)


def test_points_that_the_truth_lacks_are_unknown():
    truth = RECORDING.truth.between(0, 4)
    assert np.isnan(replace(RECORDING, truth=truth).points(7)).all()
    assert np.isfinite(RECORDING.points(7)).all()
