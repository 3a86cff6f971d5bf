"""A tiny run of the whole benchmark, and what is written of it."""

import json
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.bench import energy
from silhouette_mocap.core.bench.cameras import CameraCosts
from silhouette_mocap.core.bench.energy import EnergySettings, energy_figures
from silhouette_mocap.core.bench.energy_files import write_energy_files
from silhouette_mocap.core.bench.energy_report import as_dict, ratios_to_kern_c, v3_ending
from silhouette_mocap.core.bench.markdown import lined, readme_section, whole_report
from silhouette_mocap.core.bench.plots import Bars, bars_picture
from silhouette_mocap.core.bench.processes import two_process_ratios
from silhouette_mocap.core.bench.rows import Row, coarse_level, native_rows
from silhouette_mocap.core.bench.table1 import Scene, Teller, table1, triangles
from silhouette_mocap.core.bench.turns import Rates, Turns, measured
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.cli import main
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.native.library import load
from silhouette_mocap.core.optimisers.evolution import Evolution
from silhouette_mocap.core.progress import Silence
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.results.report import write_report
from synthetic import small_body

TINY = EnergySettings(
    Turns(1, 0.001, 64, 16), ((64, 48),), (2, 3), frames=1, fits=1, fit=Evolution(8, 3)
)
TWO_PROCESSES = {level: {"whole": 1.9, "limb": 1.8, "hand": 1.7} for level in ("exact", "lod")}
RATIO_KEYS = {"exact": {"whole", "limb", "hand"}, "lod": {"whole", "limb", "hand"}}


class Counting(Silence):
    """Progress that counts."""

    def __init__(self):
        self.total, self.done, self.notes = 0, 0, []

    def begin(self, task, total):
        self.total = total

    def advance(self, frame, figures=None):
        self.done += 1

    def note(self, text):
        self.notes.append(text)


def light_body(name):
    """A template whose full mesh has few triangles, too, and is a little slimmer."""
    body = template(name)
    coarse = body.surfaces[0]
    return replace(body, surfaces=(coarse, replace(coarse, vertices=0.98 * coarse.vertices)))


def paper_row(note):
    """The kernel in the place of OpenGL as in the paper."""
    note("no rows for OpenGL: none is wanted here")
    return [Row("opengl_paper", "OpenGL as in the paper", lambda b, c: NativeEvaluator(b, c, 1))]


@pytest.fixture(scope="module")
def progress():
    return Counting()


@pytest.fixture(scope="module")
def figures(progress):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(energy, "opengl_rows", paper_row)
        patch.setattr(energy, "template", light_body)
        patch.setattr(energy, "two_process_ratios", lambda size, turns: TWO_PROCESSES)
        return energy_figures(TINY, progress)


@pytest.fixture(scope="module")
def report(figures, tmp_path_factory):
    path = tmp_path_factory.mktemp("bench") / "energy.json"
    write_report(path, as_dict(figures))
    return json.loads(path.read_text("utf-8"))


def test_progress_counts_every_step_and_tells_what_is_left_out(figures, progress):
    assert progress.done == progress.total == TINY.steps
    assert any("prototypes" in note for note in progress.notes)
    assert list(figures.notes) == progress.notes


def test_ratios_hold_every_part_of_both_levels(report):
    to_prototypes = ("ratio_to_kern_c", "ratio_to_kern_c_v3", "ratio_to_gl_eval")
    for key in ("ratio_to_paper_gl", *to_prototypes, "two_threads", "two_processes"):
        assert {level: set(parts) for level, parts in report[key].items()} == RATIO_KEYS, key
    assert report["ratio_to_paper_gl"]["lod"]["whole"] > 0.1
    assert set(report["ratio_to_paper_gl_by_size"]) == {"64x48"}
    assert set(report["weighted_ratio"]) == {"64x48"}
    assert all(value > 0 for value in report["weighted_ratio"].values())


def test_without_the_prototypes_their_ratios_are_null(report):
    assert report["ratio_to_kern_c"]["exact"]["whole"] is None
    assert report["prototypes"] == {}


def test_the_coarse_mesh_is_judged_in_three_ways(report):
    assert 0 < report["lod_mask_xor"] < 0.2
    assert 0 <= report["lod_energy_difference"] < 0.05
    assert 0 <= report["lod_pose_change_mm"] <= report["lod_pose_change_max_mm"]
    assert report["lod_pose_change_control_mm"] >= 0
    assert 0 <= report["lod_best_pose_shift_mm"] <= report["lod_best_pose_shift_max_mm"]


def test_table_1_has_every_window_with_and_without_prerendering(report):
    for table in report["table1"].values():
        assert set(table) == {"full", "half", "limb", "hand"}
        for ways in table.values():
            assert set(ways) == {"xor", "prerendered"}
            assert all(row["per_second"] > 0 for row in ways["xor"].values())


def test_the_body_has_as_many_triangles_as_the_papers():
    body = template("sixteen_segment")
    assert triangles(body, (320, 240)) >= 21422
    assert triangles(body, (320, 240), coarse_level) < 2400
    assert triangles(body, (320, 240), coarse_level) < triangles(body, (1920, 1080), coarse_level)


def test_full_mesh_rows_agree_to_the_pixel(report):
    for table in report["table1"].values():
        for ways in table.values():
            for row in ("native_exact", "native_exact_two_threads"):
                assert ways["prerendered"][row]["differs_px"] == 0


def test_table_2_has_both_sequences_and_the_same_poses_with_and_without_prerendering(report):
    assert report["same_poses_without_prerendering"] == {"A": True, "B": True}
    for ways in report["table2"].values():
        assert set(ways) == {"xor", "prerendered", "shared_out"}
        assert ways["xor"]["evaluations_per_frame"] == ways["prerendered"]["evaluations_per_frame"]
        assert ways["xor"]["error_mm"] == ways["prerendered"]["error_mm"]


def test_the_machine_is_named_with_the_kernels_code_path(report, figures):
    path = {1: "base", 3: "x86-64-v3", 4: "x86-64-v4"}[load().sm_processor()]
    assert report["machine"]["code_path"] == path
    assert f"kernel on its {path} path" in readme_section(figures, "plots")
    assert {"processor", "cores", "load_before", "python", "opengl"} <= set(report["machine"])


def test_the_report_says_what_is_no_median_and_names_the_ceiling_of_two_threads(figures):
    text = whole_report(figures)
    assert "medians, but for the cost per camera" in text and "Of each row's best turn" in text
    assert "`lod_pose_change_mm` is the mean and `lod_pose_change_max_mm` the largest" in text
    rows = [line for line in text.splitlines() if "two processes to one" in line]
    assert len(rows) == 2 and all("| 1.90x | 1.80x | 1.70x |" in row for row in rows)


def test_two_processes_are_measured_for_every_part():
    found = two_process_ratios((64, 48), TINY.turns)
    assert {level: set(parts) for level, parts in found.items()} == RATIO_KEYS
    assert all(0.2 < value < 20 for parts in found.values() for value in parts.values())


def test_both_ways_of_a_cell_take_turns(monkeypatch):
    groups = []

    def spied(variants, candidates, turns):
        groups.append([variant.group for variant in variants])
        return measured(variants, candidates, turns)

    monkeypatch.setattr("silhouette_mocap.core.bench.table1.measured", spied)
    body = small_body("sixteen_segment")
    scene, tell = Scene(body, body.rest_pose, body.rest_pose), Teller(print, lambda: None)
    table = table1(scene, (48, 36), [native_rows()[3]], replace(TINY.turns, poses=16), tell)
    assert groups == [["xor", "prerendered"]] * 4 and len(table) == 8


def test_ratios_on_the_v3_path_are_those_of_its_rows():
    rows = {"native_exact": 8.0, "native_exact_v3": 6.0, "native_lod": 40.0, "native_lod_v3": 20.0}
    rows |= {"prototype_kern_c_full_winding": 2.0, "prototype_kern_c_coarse_lists": 10.0}
    rates = Rates(tuple(rows), np.array([list(rows.values())]), (1,) * 6, (0,) * 6)
    for path, exact, coarse in (("x86-64-v4", 3.0, 2.0), ("x86-64-v3", 4.0, 4.0)):
        ratios = ratios_to_kern_c({"hand": rates}, v3_ending({"code_path": path}))
        assert ratios == {"exact": {"hand": exact}, "lod": {"hand": coarse}}
    nothing = ratios_to_kern_c({"hand": rates}, v3_ending({"code_path": "base"}))
    assert nothing["lod"]["hand"] is None


def test_files_are_whole_tables_and_pictures(figures, tmp_path):
    paths = write_energy_files(figures, tmp_path)
    assert {p.name for p in paths} >= {"energy.md", "readme.md", "speed.svg", "cameras.svg"}
    for path in paths:
        if path.suffix == ".svg":
            ElementTree.fromstring(path.read_text("utf-8"))
    text = (tmp_path / "energy.md").read_text("utf-8")
    for block in re.findall(r"(?:^\|.*\|$\n?)+", text, re.MULTILINE):
        assert len({line.count("|") for line in block.splitlines()}) == 1
    for name in re.findall(r"!\[.*?\]\((.*?)\)", text):
        assert (tmp_path / name).is_file()


def test_a_table_is_lined_with_numbers_to_the_right():
    assert lined(["", "s"], [["a", "1"]]) == "|  | s |\n| --- | ---: |\n| a | 1 |"


def test_costs_on_a_line_have_no_residual_and_others_have():
    counts = [2, 4, 8]
    costs = CameraCosts.fitted(counts, [5e-6 + 3e-6 * n for n in counts])
    assert costs.per_camera == pytest.approx(3e-6)
    assert costs.fixed == pytest.approx(5e-6)
    assert costs.largest_residual < 1e-9
    bent = CameraCosts.fitted(counts, [n**2 for n in counts])
    assert bent.largest_residual == pytest.approx(np.abs(1 - bent.seconds / bent.line).max())
    assert bent.largest_residual > 0.1


def test_bars_are_as_long_as_the_logarithm_of_their_values():
    bars = Bars("t", "u", {"a": {"x": 10.0}, "b": {"x": 100.0}, "c": {"x": 1000.0, "y": None}})
    picture = ElementTree.fromstring(bars_picture(bars))
    shapes = picture.findall(".//{http://www.w3.org/2000/svg}rect")
    wide = [float(s.attrib["width"]) for s in shapes if s.attrib.get("height") == "11"]
    assert len(wide) == 3
    assert wide[2] == pytest.approx(2 * wide[1], rel=0.01)


def test_a_folder_without_prototypes_is_refused_in_one_line(tmp_path, capsys):
    assert main(["bench", "energy", "--prototypes", str(tmp_path)]) == 2
    assert "does not hold the prototypes" in capsys.readouterr().err


def test_the_command_writes_what_it_measured(monkeypatch, tmp_path, capsys, figures):
    monkeypatch.setattr(
        "silhouette_mocap.core.cli.bench.energy_figures", lambda settings, progress: figures
    )
    words = ["bench", "energy", "--json", str(tmp_path / "new" / "e.json"), "--out", str(tmp_path)]
    assert main(words) == 0
    assert "Table 1 at 64x48" in capsys.readouterr().out
    assert "ratio_to_paper_gl" in json.loads((tmp_path / "new" / "e.json").read_text("utf-8"))


@pytest.mark.parametrize("option", ["--json", "--out"])
def test_what_cannot_be_written_is_refused_before_the_work(option, monkeypatch, tmp_path, capsys):
    def never(settings, progress):
        raise AssertionError("worked")

    monkeypatch.setattr("silhouette_mocap.core.cli.bench.energy_figures", never)
    (tmp_path / "file").write_text("mine")
    places = [tmp_path / "file" / "new"]
    places.append(tmp_path if option == "--json" else tmp_path / "file")
    for place in places:
        assert main(["bench", "energy", option, str(place)]) == 2
        error = capsys.readouterr().err
        assert error.count("\n") == 1 and str(tmp_path) in error
    with monkeypatch.context() as patch:
        patch.setattr("silhouette_mocap.core.files.os.access", lambda path, mode: False)
        place = tmp_path / "new.json" if option == "--json" else tmp_path
        assert main(["bench", "energy", option, str(place)]) == 2
    assert "cannot be written (Permission denied)" in capsys.readouterr().err


def test_settings_count_the_comparisons_with_prototypes(tmp_path):
    with_them = replace(TINY, prototypes=tmp_path)
    assert with_them.steps == TINY.steps + 3
    notes = []
    assert energy._prototype_figures(with_them, Teller(notes.append, lambda: None)) == {}
    assert "are not at hand" in notes[0]


def test_a_row_that_fails_at_a_size_is_left_out_and_told():
    def refuse(body, cameras):
        raise MocapError("too large a picture")

    body, notes = small_body("sixteen_segment"), []
    scene = Scene(body, body.rest_pose, body.rest_pose)
    rows = [native_rows()[3], Row("broken", "the broken one", refuse)]
    tell = Teller(notes.append, lambda: None)
    table = table1(scene, (48, 36), rows, replace(TINY.turns, poses=16), tell)
    assert {rates.names for rates in table.values()} == {("native_lod",)}
    assert "the broken one is left out at (48, 36): too large a picture" in notes
