"""Pictures: the bytes of the command line, as arrays; ended by signals."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import rtc


def command(*words, **more):
    return subprocess.run([sys.executable, "-m", "rtc", *words], capture_output=True, check=False, **more)


def test_a_picture_has_the_bytes_of_the_command_line(tmp_path, scenes):
    for name, words in [("camera.yaml", {"size": 64}), ("vases.yaml", {"size": (48, 32), "spp": 4})]:
        image = rtc.load(scenes / name).render(**words)
        size = words["size"]
        size = f"{size}x{size}" if isinstance(size, int) else f"{size[0]}x{size[1]}"
        more = ["--spp", "4"] if "spp" in words else []
        done = command("render", str(scenes / name), "--size", size, *more, "-q", "-o", "-")
        assert done.returncode == 0, done.stderr
        assert image.encode() == done.stdout
        assert image._repr_png_() == done.stdout
        image.save(tmp_path / "x.png")
        assert (tmp_path / "x.png").read_bytes() == done.stdout


def test_arrays_have_their_shape_and_kind(ball):
    image = rtc.load(ball).render(aovs=["depth", "normal"])
    assert (image.array.shape, image.array.dtype) == ((24, 32, 3), np.float32)
    assert (image.rgba8.shape, image.rgba8.dtype) == ((24, 32, 4), np.uint8)
    assert (np.asarray(image) == image.array).all()
    assert (np.floor(np.clip(image.array, 0, 1) * 255) == image.rgba8[..., :3]).mean() > 0.99
    depth, normal = image.aovs["depth"], image.aovs["normal"]
    assert (depth.shape, normal.shape) == ((24, 32, 1), (24, 32, 3))
    assert abs(depth[12, 16, 0] - 8) < 0.01 and depth[0, 0, 0] == 1e10
    assert image.stats["rays"] >= image.stats["camera_rays"] >= image.stats["hits"] > 0
    clear = rtc.load(ball).render(transparent=True)
    assert clear.array.shape == (24, 32, 4) and clear.array[0, 0, 3] == 0


def test_arrays_can_be_written(ball):
    image = rtc.load(ball).render(aovs=["depth"])
    for values in (image.array, image.rgba8, image.aovs["depth"]):
        values[0, 0] = 0
    assert image.aovs["depth"][0, 0, 0] == 1e10


def test_numbers_of_numpy_are_taken(ball):
    scene = rtc.load(ball)
    image = scene.render(size=np.int64(8), settings={"supersampling": np.int32(2), "toon": np.bool_(False)})
    assert image.array.shape == (8, 8, 3)
    assert scene.render(size=np.array([4, 6])).array.shape == (6, 4, 3)


def test_the_picture_so_far_is_shown(ball):
    pictures = []
    last = rtc.load(ball).render(size=300, supersampling=8, on_picture=pictures.append)
    assert pictures
    for picture in pictures:
        is_done = picture.rgba8[..., 3] > 0
        assert not is_done.all()
        assert (picture.rgba8[is_done] == last.rgba8[is_done]).all()
    done = [np.count_nonzero(picture.rgba8[..., 3]) for picture in pictures]
    assert done == sorted(done) and done[-1] > 0


def test_progress_is_told(ball, capfd):
    shares = []
    rtc.load(ball).render(size=200, supersampling=4, progress=shares.append)
    assert shares[-1] == 1 and shares == sorted(shares)
    rtc.load(ball).render(size=8, progress=True)
    assert "100%" in capfd.readouterr().err
    with pytest.raises(ZeroDivisionError):
        rtc.load(ball).render(progress=lambda share: 1 / 0)


def test_linear_values_and_their_files(tmp_path, ball):
    image = rtc.load(ball).render(format="exr")
    shown = image._repr_png_()
    (tmp_path / "shown.png").write_bytes(shown)
    linear = rtc.load(ball).render(tonemap="srgb")
    assert rtc.diff(tmp_path / "shown.png", linear).max <= 1
    image.save(tmp_path / "x.exr")
    assert (tmp_path / "x.exr").read_bytes()[:4] == b"\x76\x2f\x31\x01"
    with pytest.raises(rtc.SceneError, match="made for a .exr"):
        image.save(tmp_path / "x.png")


def test_a_target_error_is_said(scenes):
    image = rtc.load(scenes / "mirrors.yaml").render(size=40, target_error=4)
    assert 0 < image.error <= 4
    assert rtc.load(scenes / "mirrors.yaml").render(size=8).error is None


def test_a_difference_is_that_of_the_command_line(tmp_path, ball):
    fine = rtc.load(ball).render(supersampling=4)
    crude = rtc.load(ball).render(supersampling=1)
    assert rtc.diff(fine, fine).max == 0
    found = rtc.diff(crude, fine)
    crude.save(tmp_path / "crude.png")
    assert found.rmse > 0 and rtc.diff(tmp_path / "crude.png", fine) == found
    with pytest.raises(ValueError, match="of one size"):
        rtc.diff(fine, rtc.load(ball).render(size=8))


def test_any_setting_can_be_set(ball):
    scene = rtc.load(ball)
    fine = scene.render(settings={"supersampling": 4})
    assert rtc.diff(fine, scene.render(supersampling=4)).max == 0
    with pytest.raises(rtc.SceneError, match="there is no setting `samples`"):
        scene.render(settings={"samples": 4})


def test_other_threads_of_python_run_meanwhile(ball):
    scene, done, turns = rtc.load(ball), threading.Event(), [0]

    def render():
        scene.render(size=400, supersampling=8)
        done.set()

    thread = threading.Thread(target=render)
    thread.start()
    while not done.wait(0.001):
        turns[0] += 1
    thread.join()
    # One that held the lock of Python would leave no turn to this one.
    assert turns[0] > 3


@pytest.mark.skipif(os.name != "posix", reason="signals of this kind are those of POSIX")
def test_an_interrupt_ends_a_render(tmp_path, ball):
    program = """
        import rtc, sys
        scene = rtc.load(sys.argv[1])
        print("begun", flush=True)
        try:
            scene.render(size=4000, supersampling=16)
        except KeyboardInterrupt:
            print("interrupted", flush=True)
    """
    path = tmp_path / "ball.yaml"
    path.write_text(ball)
    words = [sys.executable, "-c", textwrap.dedent(program), str(path)]
    child = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "begun\n"
    time.sleep(0.5)
    child.send_signal(signal.SIGINT)
    assert child.communicate(timeout=60)[0] == "interrupted\n"


def test_the_command_line_is_in_the_wheel(tmp_path, ball):
    path = tmp_path / "ball.yaml"
    path.write_text(ball.replace("radius: 1", "radius: -1"))
    program = os.path.join(os.path.dirname(sys.executable), "rtc")
    done = subprocess.run([program, "check", path], capture_output=True, check=False)
    assert done.returncode == 1 and b"error[VA" in done.stderr
    assert command("--version").stdout.startswith(b"rtc ")
    assert command("frobnicate").returncode == 2
