//! Pictures in other forms than PNG and EXR.

use super::*;

#[test]
fn a_webp_holds_the_pixels_of_the_png_and_a_jpeg_nearly() {
    let folder = folder();
    let made = |name: &str| {
        let output = rtc(&folder, &["render", "ball.json", "-q", "-o", name]);
        assert_eq!(code(&output), 0, "{name}: {}", stderr(&output));
        let bytes = fs::read(folder.path().join(name)).unwrap();
        (image::load_from_memory(&bytes).unwrap().to_rgb8(), bytes)
    };
    let (png, _) = made("a.png");
    assert_eq!(made("a.webp").0, png);
    let ((jpeg, bytes), (_, again)) = (made("a.jpg"), made("b.JPEG"));
    assert_eq!(bytes, again);
    let apart = jpeg
        .iter()
        .zip(png.iter())
        .map(|(a, b)| u32::from(a.abs_diff(*b)));
    let mean = f64::from(apart.sum::<u32>()) / png.len() as f64;
    assert!(bytes.starts_with(b"\xff\xd8\xff") && mean < 4.0, "{mean}");
}

#[test]
fn a_radiance_hdr_holds_the_values_of_the_film() {
    let folder = folder();
    let made = |args: &[&str]| {
        let fixed = ["render", "ball.json", "-q", "--exposure", "-1", "-o"];
        let output = rtc(&folder, &[&fixed, args].concat());
        assert_eq!(code(&output), 0, "{args:?}: {}", stderr(&output));
        image::open(folder.path().join(args[0]))
            .unwrap()
            .to_rgb32f()
    };
    let (png, hdr) = (made(&["a.png", "--bits", "16"]), made(&["a.hdr"]));
    for (exact, read) in png.pixels().zip(hdr.pixels()) {
        let largest = exact.0.into_iter().fold(0.001, f32::max);
        let is_near = |(a, b): (f32, f32)| (a - b.min(1.0)).abs() <= largest / 255.0;
        assert!(
            exact.0.into_iter().zip(read.0).all(is_near),
            "{exact:?} {read:?}"
        );
    }
    assert_eq!(hdr, made(&["b.hdr", "--strips=16", "--bits", "32"]));
}

#[test]
fn what_a_form_does_not_hold_is_refused() {
    let folder = folder();
    let cases = [
        (
            &["-o", "a.jpg", "--background", "transparent"][..],
            "has no opacity",
        ),
        (
            &["-o", "a.hdr", "--background", "transparent"],
            "has no opacity",
        ),
        (
            &["-o", "a.webp", "--bits", "16"],
            "the channels of WebP files have 8 bits, not 16",
        ),
        (&["-o", "a.jpg", "--aov", "depth"], "layers need a PNG"),
        (&["-o", "a.webp", "--strips"], "compressed as a whole"),
    ];
    for (args, words) in cases {
        let refused = rtc(&folder, &[&["render", "ball.json"], args].concat());
        let said = stderr(&refused);
        assert!(
            code(&refused) == 2 && said.contains(words),
            "{args:?}: {said}"
        );
    }
    assert_eq!(names(folder.path()), ["away.json", "bad.json", "ball.json"]);
}

#[test]
fn parts_merge_to_a_picture_of_their_kind_alone() {
    let folder = folder();
    for part in ["1/2", "2/2"] {
        let args = [
            "render",
            "ball.json",
            "-q",
            "--part",
            part,
            "--picture",
            "a.webp",
        ];
        assert_eq!(code(&rtc(&folder, &args)), 0);
    }
    let merge = |name: &str| {
        let parts = [
            "merge",
            "ball.1-of-2.rtp",
            "ball.2-of-2.rtp",
            "-q",
            "-o",
            name,
        ];
        rtc(&folder, &parts)
    };
    let refused = stderr(&merge("a.png"));
    assert!(
        refused.contains("the parts are of WebP") && refused.contains("`--picture NAME.png`"),
        "{refused}"
    );
    assert_eq!(code(&merge("a.webp")), 0);
    assert_eq!(
        code(&rtc(
            &folder,
            &["render", "ball.json", "-q", "-o", "b.webp"]
        )),
        0
    );
    let read = |name| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("a.webp"), read("b.webp"));
}

/// The pictures of an APNG, and how long each is shown, in seconds.
fn frames(path: &Path) -> Vec<(Vec<u8>, f64)> {
    let file = std::io::Cursor::new(fs::read(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let count = reader.info().animation_control.unwrap().num_frames;
    let frame = |_| {
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let shown = reader.info().frame_control.unwrap();
        (
            pixels,
            f64::from(shown.delay_num) / f64::from(shown.delay_den),
        )
    };
    (0..count).map(frame).collect()
}

#[test]
fn a_turntable_in_one_file_has_the_pictures_of_its_frames() {
    let folder = folder();
    let made = |args: &[&str]| {
        let all = [
            &[
                "render",
                "ball.json",
                "-q",
                "--size",
                "8x6",
                "--turntable",
                "3",
            ],
            args,
        ];
        let output = rtc(&folder, &all.concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    };
    let path = |name: &str| folder.path().join(name);
    made(&["-o", "f.png"]);
    made(&["-o", "a.apng"]);
    made(&["-o", "b.apng", "--threads", "1"]);
    made(&["-o", "c.apng", "--fps", "4", "--frames", "2..3"]);
    assert_eq!(
        fs::read(path("a.apng")).unwrap(),
        fs::read(path("b.apng")).unwrap()
    );
    let still = |number: u32| {
        let picture = image::open(path(&format!("f-000{number}.png"))).unwrap();
        picture.to_rgb8().into_raw()
    };
    let shown = |numbers: &[u32], time: f64| -> Vec<(Vec<u8>, f64)> {
        numbers
            .iter()
            .map(|number| (still(*number), time))
            .collect()
    };
    assert_eq!(frames(&path("a.apng")), shown(&[1, 2, 3], 1.0 / 12.0));
    assert_eq!(frames(&path("c.apng")), shown(&[2, 3], 0.25));
    assert_ne!(still(1), still(2));
}

/// Colours are those of the frames where there are no more than a GIF holds.
#[test]
fn a_turntable_as_gif_has_the_colours_of_its_frames() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let made = |args: &[&str]| {
        let fixed = ["render", "ball.json", "--size", "8x6", "--turntable", "3"];
        let output = rtc(&folder, &[&fixed, args].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        stderr(&output)
    };
    made(&["-q", "-o", "f.png"]);
    let said = made(&["-o", "a.gif", "--fps", "20"]);
    assert!(said.contains("256 colours"), "{said}");
    made(&["-q", "-o", "b.gif", "--fps", "20", "--threads", "1"]);
    let bytes = fs::read(path("a.gif")).unwrap();
    assert_eq!(bytes, fs::read(path("b.gif")).unwrap());
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut reader = options.read_info(bytes.as_slice()).unwrap();
    assert_eq!((reader.width(), reader.height()), (8, 6));
    for number in 1..=3 {
        let frame = reader.read_next_frame().unwrap().unwrap();
        assert_eq!(frame.delay, 5);
        let still = image::open(path(&format!("f-000{number}.png"))).unwrap();
        let still = still.to_rgba8().into_raw();
        let apart = frame
            .buffer
            .iter()
            .zip(&still)
            .map(|(a, b)| a.abs_diff(*b))
            .max();
        assert!(apart <= Some(4), "{number}: {apart:?}");
    }
    assert!(reader.read_next_frame().unwrap().is_none());
}

#[test]
fn an_animation_appears_whole_or_not_at_all() {
    let folder = folder();
    let before = names(folder.path());
    let cases = [
        (&["ball.json"][..], 2, "give `--turntable N`"),
        (
            &["ball.json", "--turntable", "2", "--strips"],
            2,
            "`--strips`",
        ),
        (
            &["ball.json", "--turntable", "2", "--checkpoint", "a.rtp"],
            2,
            "`--checkpoint`",
        ),
        (&["bad.json", "--turntable", "2"], 1, "error["),
        (
            &["ball.json", "--turntable", "2", "--limit", "rays=5000"],
            1,
            "error[RD",
        ),
    ];
    for (args, exit, words) in cases {
        let refused = rtc(&folder, &[&["render", "-o", "a.apng"], args].concat());
        let said = stderr(&refused);
        assert!(
            code(&refused) == exit && said.contains(words),
            "{args:?}: {said}"
        );
        assert_eq!(names(folder.path()), before, "{args:?}");
    }
    let args = ["render", "ball.json", "--turntable", "2", "--fps", "4"];
    assert_eq!(code(&rtc(&folder, &args)), 2);
}
