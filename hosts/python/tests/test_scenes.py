"""Scenes: read from files and memory, checked, refused."""

import pytest

import rtc


def test_a_scene_in_memory_a_file_and_bytes_are_alike(tmp_path, ball):
    path = tmp_path / "ball.yaml"
    path.write_text(ball)
    pictures = [rtc.load(source).render().array for source in (ball, path, str(path), ball.encode())]
    assert all((picture == pictures[0]).all() for picture in pictures)


def test_files_beside_a_scene_in_memory_are_read():
    obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    text = "Eye: [0, 0, 9]\nLights: []\nObjects:\n- {type: mesh, file: t.obj, material: {color: [1, 1, 1], ka: 1, kd: 0, ks: 0, n: 1}}\n"
    findings = rtc.load(text, files={"t.obj": obj}).check()
    assert not [found for found in findings if found.severity == "error"], findings
    missing = rtc.load(text).check()
    assert [found.severity for found in missing].count("error") == 1


def test_findings_have_their_place_and_text(ball):
    [finding] = rtc.load(ball.replace("radius: 1", "radius: -1"), name="b.yaml").check()
    assert (finding.severity, finding.file, finding.line, finding.column) == ("error", "b.yaml", 7, 11)
    assert finding.code.startswith("VA") and finding.message.startswith("the radius")
    assert "b.yaml:7:11" in str(finding) and "^" in str(finding)


def test_a_scene_with_errors_raises_what_was_found(ball):
    scene = rtc.load(ball.replace("radius: 1", "radius: -1"))
    with pytest.raises(rtc.SceneError, match="has an error") as raised:
        scene.render()
    assert [finding.line for finding in raised.value.findings] == [7]


def test_what_is_not_there_raises(tmp_path):
    with pytest.raises(FileNotFoundError, match="none.yaml"):
        rtc.load(tmp_path / "none.yaml")
    with pytest.raises(rtc.SceneError) as raised:
        rtc.load(tmp_path)
    assert isinstance(raised.value, ValueError) and raised.value.findings[0].code == "IO001"


def test_words_that_do_not_fit_are_told(ball):
    scene = rtc.load(ball)
    with pytest.raises(ValueError, match="no layer `colour`; there are albedo"):
        scene.render(aovs=["colour"])
    with pytest.raises(ValueError, match="no format `gif`"):
        scene.render(format="gif")
    with pytest.raises(rtc.SceneError, match="at least one pixel"):
        scene.render(size=0)


def test_a_study_has_rows_and_says_which_is_the_scenes_own(ball):
    rows = rtc.load(ball).cost()
    assert len(rows) > 2 and rows.study["schema"].startswith("rtc-cost/")
    assert all("errors" in row for row in rows)


def test_a_study_of_a_scene_with_errors_tells_them(ball):
    with pytest.raises(ValueError, match="VA"):
        rtc.load(ball.replace("radius: 1", "radius: -1")).cost()
