"""What makes a first fit doubtful, though it could be a performer."""

from collections.abc import Sequence

from ..fitting.scores import FrameScores
from ..silhouettes.silhouette import Silhouette
from .sightings import FEWEST_WHOLE, is_whole

_UNEXPLAINED_M2 = 0.035
"""Of a silhouette; badly segmented ones leave less, raised arms that are not found leave more."""


def doubts_about(scores: FrameScores, silhouettes: Sequence[Silhouette]) -> tuple[str, ...]:
    """Sentences on the first fit, whose ``scores`` are those against V ``silhouettes``."""
    notes = []
    if sum(map(is_whole, silhouettes)) < FEWEST_WHOLE:
        notes.append(
            "fewer than two cameras see the whole performer in the initial pose: what they do not "
            "see is the average person's; name other initial_pose frames if there are better ones"
        )
    lumps = float(scores.lumps.max() / max(scores.view_weights.sum(), 1e-9))
    if lumps > _UNEXPLAINED_M2:
        notes.append(
            f"the body leaves {1e4 * lumps:.0f} cm² of each silhouette unexplained and may be "
            "wrong: check that the frames of initial_pose show the pose that is named, and the "
            "silhouettes"
        )
    return tuple(notes)
