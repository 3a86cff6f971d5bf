"""Finished frames outlive whatever ends the program."""

import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import points
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.fitting.scores import FrameScores
from silhouette_mocap.core.fitting.tracker import Tally
from silhouette_mocap.core.fitting.tracking import FrameFit
from silhouette_mocap.core.results.journal import SET_ASIDE, UNFINISHED, Journal, Start, set_aside
from synthetic import small_body

VIEWS = 3
KINDS = "native", "opengl"
PICTURE = np.zeros((8, 8, 3), np.uint8)


def frame_fit(frame: int) -> FrameFit:
    rng = np.random.default_rng(frame)
    body = small_body("sixteen_segment")
    scores = FrameScores(
        xor_px=rng.integers(0, 999, VIEWS),
        iou=np.array([0.1, np.nan, 1 / 3]),
        contour_px=rng.random(),
        limb_residual=rng.random(5),
        unexplained=rng.random(5),
        view_weights=rng.random(VIEWS),
        lumps=rng.random(5),
        point_spreads=rng.random(14),
        dof_spreads=rng.random(len(body.dofs)),
        confidence=rng.random(14),
        lost=bool(frame % 2),
    )
    return FrameFit(frame, rng.random(len(body.dofs)), scores, Tally(frame, 7), rng.random())


def stamps(frame: int) -> np.ndarray:
    return np.arange(VIEWS * 2).reshape(VIEWS, 2) + frame * 10**15


def begun(folder, frames=()) -> Journal:
    body = small_body("sixteen_segment")
    start = Start(
        inputs={"fps": "15"},
        factors=(1, 2, 1),
        frames=np.array([0, 2]),
        stamps=np.stack([stamps(0), stamps(2)]),
        body=body,
        pose=body.rest_pose + 0.1,
        notes=("beware",),
    )
    journal = Journal.begun(folder, start)
    for frame in frames:
        journal.add(frame_fit(frame), stamps(frame), PICTURE, KINDS[frame % 2])
    return journal


def test_what_was_added_comes_back_to_the_last_bit(tmp_path):
    begun(tmp_path / "j", (5, 6, 4))
    journal = Journal.opened(tmp_path / "j")
    assert len(journal) == 3
    assert list(journal) == [5, 6, 4]
    for frame, found in journal.items():
        wanted = frame_fit(frame)
        assert (found.frame, found.tally, found.seconds) == (frame, wanted.tally, wanted.seconds)
        np.testing.assert_array_equal(found.pose, wanted.pose)
        for name in vars(wanted.scores):
            np.testing.assert_array_equal(
                getattr(found.scores, name), getattr(wanted.scores, name), strict=True
            )
    assert journal.evaluators() == {"opengl": 1, "native": 2}
    frames, kept = journal.stamps()
    np.testing.assert_array_equal(frames, [5, 6, 4])
    np.testing.assert_array_equal(kept, [stamps(f) for f in (5, 6, 4)])


def test_how_it_began_comes_back(tmp_path):
    wanted = begun(tmp_path / "j").start
    found = Journal.opened(tmp_path / "j").start
    assert (found.inputs, found.factors, found.notes) == ({"fps": "15"}, (1, 2, 1), ("beware",))
    for name in ("pose", "frames", "stamps"):
        np.testing.assert_array_equal(getattr(found, name), getattr(wanted, name))
    pose = wanted.pose[None]
    np.testing.assert_array_equal(points(found.body, pose), points(wanted.body, pose))


@pytest.mark.parametrize("lost", [1, 40, -1])
def test_a_record_cut_short_is_dropped_and_the_next_takes_its_place(tmp_path, lost):
    begun(tmp_path / "j", (5, 6))
    file = tmp_path / "j" / "frames.bin"
    whole = file.read_bytes()
    file.write_bytes(whole[:-lost] if lost > 0 else whole + b"\0" * 30)
    journal = Journal.opened(tmp_path / "j")
    kept = list(journal)
    assert kept == ([5] if lost > 0 else [5, 6])
    journal.add(frame_fit(9), stamps(9), PICTURE, KINDS[0])
    assert list(Journal.opened(tmp_path / "j")) == [*kept, 9]


def test_a_damaged_record_ends_the_journal(tmp_path):
    begun(tmp_path / "j", (5, 6, 7))
    file = tmp_path / "j" / "frames.bin"
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)
    assert list(Journal.opened(tmp_path / "j")) == [5]


def test_a_frame_whose_picture_is_cut_short_counts_as_not_finished(tmp_path):
    picture = begun(tmp_path / "j", (5, 6)).picture(6)
    picture.write_bytes(picture.read_bytes()[:-5])
    assert list(Journal.opened(tmp_path / "j")) == [5]


@pytest.mark.parametrize("name", ["frames.bin", ""])
def test_a_journal_that_goes_while_it_is_used_is_a_fault(tmp_path, name):
    journal = begun(tmp_path / "j", (5, 6))
    (tmp_path / "j" / name).rename(tmp_path / "elsewhere")
    begun(tmp_path / "j", (1,)) if not name else None
    for use in (
        lambda: journal[5],
        lambda: journal.add(frame_fit(7), stamps(7), PICTURE, KINDS[0]),
    ):
        with pytest.raises(MocapError, match=r"j: was moved or removed while the fit ran; give"):
            use()


def test_frames_that_are_changed_behind_its_back_are_a_fault(tmp_path):
    journal = begun(tmp_path / "j", (5, 6))
    with (tmp_path / "j" / "frames.bin").open("r+b") as stream:
        stream.seek(50)
        stream.write(b"other")
    with pytest.raises(MocapError, match="was changed while the fit ran"):
        dict(journal)


def test_a_frame_without_its_picture_counts_as_not_finished(tmp_path):
    begun(tmp_path / "j", (5, 6)).picture(6).unlink()
    assert list(Journal.opened(tmp_path / "j")) == [5]


def test_a_journal_whose_beginning_is_not_whole_is_none(tmp_path):
    assert Journal.opened(tmp_path / "j") is None
    begun(tmp_path / "j")
    (tmp_path / "j" / "start.npz").unlink()
    assert Journal.opened(tmp_path / "j") is None


def test_a_damaged_beginning_is_a_fault(tmp_path):
    begun(tmp_path / "j")
    (tmp_path / "j" / "start.npz").write_bytes(b"junk")
    with pytest.raises(MocapError, match=r"start\.npz: cannot be read.*leave out --resume"):
        Journal.opened(tmp_path / "j")
    np.savez(tmp_path / "j" / "start.npz", pose=np.zeros(3))
    with pytest.raises(MocapError, match=r"start\.npz: is no start of a fit; leave out"):
        Journal.opened(tmp_path / "j")


def test_a_journal_is_set_aside_over_an_older_one(tmp_path):
    for frames in ((1,), (2, 3)):
        begun(tmp_path / UNFINISHED, frames)
        assert set_aside(tmp_path)
    assert not (tmp_path / UNFINISHED).exists()
    assert list(Journal.opened(tmp_path / SET_ASIDE)) == [2, 3]


def test_a_longer_journal_set_aside_before_stays(tmp_path):
    for frames in ((1, 2, 3), (4,)):
        begun(tmp_path / UNFINISHED, frames)
        assert set_aside(tmp_path)
    assert not (tmp_path / UNFINISHED).exists() and len(Journal.opened(tmp_path / SET_ASIDE)) == 3


def test_what_an_ended_journal_has_left_goes(tmp_path):
    begun(tmp_path / UNFINISHED, (1, 2))
    (tmp_path / UNFINISHED / "start.npz").unlink()
    assert not set_aside(tmp_path) and not list(tmp_path.iterdir())


def test_an_empty_journal_replaces_none(tmp_path):
    begun(tmp_path / UNFINISHED, (1,))
    set_aside(tmp_path)
    begun(tmp_path / UNFINISHED)
    assert not set_aside(tmp_path) and not (tmp_path / UNFINISHED).exists()
    assert len(Journal.opened(tmp_path / SET_ASIDE)) == 1


def test_frames_of_another_version_are_neither_cut_nor_thrown_away(tmp_path):
    begun(tmp_path / UNFINISHED, (1, 2))
    file = tmp_path / UNFINISHED / "frames.bin"
    other = file.read_bytes() + b"more in each record"
    file.write_bytes(other[7:])
    Journal.opened(tmp_path / UNFINISHED)
    assert file.read_bytes() == other[7:]
    assert set_aside(tmp_path) and (tmp_path / SET_ASIDE / "frames.bin").read_bytes() == other[7:]


def test_an_ended_journal_leaves_nothing(tmp_path):
    begun(tmp_path / "j", (1,)).remove()
    assert not (tmp_path / "j").exists()


def test_what_is_not_the_journal_s_own_stays(tmp_path):
    begun(tmp_path / UNFINISHED, (1,))
    (tmp_path / UNFINISHED / "thesis.txt").write_text("mine", "utf-8")
    Journal.opened(tmp_path / UNFINISHED).remove()
    set_aside(tmp_path)
    assert [path.name for path in (tmp_path / UNFINISHED).iterdir()] == ["thesis.txt"]
