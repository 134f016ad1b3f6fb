//! `rtc diff` from outside.

use super::*;

/// Two pictures of the ball: as the scene says, and without supersampling; of a kind.
fn pictures(kind: &str, more: &[&str]) -> TempDir {
    let folder = folder();
    for (name, samples) in [("two", "2"), ("one", "1")] {
        let picture = format!("{name}.{kind}");
        let args = [
            "render",
            "ball.json",
            "-q",
            "--supersampling",
            samples,
            "-o",
            &picture,
        ];
        let output = rtc(&folder, &[&args, more].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    }
    folder
}

fn diff(folder: &TempDir, args: &[&str]) -> (i32, String, String) {
    let output = rtc(folder, &[&["diff"], args].concat());
    let told = String::from_utf8(output.stdout.clone()).unwrap();
    (code(&output), told, stderr(&output))
}

#[test]
fn the_same_picture_has_no_difference() {
    for (kind, more) in [("png", &[][..]), ("png", &["--bits", "16"]), ("exr", &[])] {
        let folder = pictures(kind, more);
        let name = format!("two.{kind}");
        let (code, told, _) = diff(&folder, &[&name, &name, "--gate", "rmse<=0"]);
        assert_eq!(
            (code, told),
            (0, format!("{name} and {name}: 40×30, no difference\n"))
        );
    }
}

#[test]
fn edges_without_supersampling_are_off() {
    for (kind, more) in [("png", &[][..]), ("png", &["--bits", "16"]), ("exr", &[])] {
        let folder = pictures(kind, more);
        let names = [format!("one.{kind}"), format!("two.{kind}")];
        let args = [names[0].as_str(), &names[1], "--json", "-o", "map.png"];
        let (code, told, _) = diff(&folder, &args);
        assert_eq!(code, 0);
        let report: serde_json::Value = serde_json::from_str(&told).unwrap();
        assert_eq!(report["size"], serde_json::json!([40, 30]));
        let found = |name: &str| report["difference"][name].as_f64().unwrap();
        assert!(found("rmse") > 1.0 && found("rmse") < found("max") && found("max") > 10.0);
        assert!(
            found("share") > 0.01 && found("share") < 0.3,
            "only edges: {told}"
        );
        assert!(found("flip") > 0.0 && found("relMse") > 0.0);
        let map = image::open(folder.path().join("map.png"))
            .unwrap()
            .to_rgb8();
        let lit = map.pixels().filter(|pixel| pixel.0[0] > 15).count();
        assert!(
            map.dimensions() == (40, 30) && lit > 10 && lit < 400,
            "{lit}"
        );
        let [column, row] = [0, 1].map(|k| report["difference"]["maxAt"][k].as_u64().unwrap());
        assert!(column < 40 && row < 30);
    }
}

#[test]
fn sixteen_bits_are_not_rounded_to_eight() {
    let folder = pictures("png", &["--bits", "16"]);
    let path = folder.path().join("two.png");
    let mut picture = image::open(&path).unwrap().to_rgb16();
    picture.get_pixel_mut(3, 4).0[1] ^= 1;
    picture.save(folder.path().join("bit.png")).unwrap();
    let (_, told, _) = diff(&folder, &["bit.png", "two.png"]);
    assert!(
        told.contains("max     0.00 grey levels, first in column 3, row 4"),
        "{told}"
    );
}

#[test]
fn a_gate_that_is_not_met_ends_with_1() {
    let folder = pictures("png", &[]);
    let gate = |gate| diff(&folder, &["one.png", "two.png", "-q", "--gate", gate]);
    assert_eq!(
        gate("rmse<=100, share<=90%"),
        (0, String::new(), String::new())
    );
    let (code, told, said) = gate("rmse<=0.5,flip<=1");
    assert_eq!((code, told.as_str(), said.lines().count()), (1, "", 1));
    assert!(said.starts_with("gate not met: rmse is ") && said.ends_with("at most 0.5 wanted\n"));
    let (code, _, said) = gate("speed<=1");
    assert!(
        code == 2 && said.contains("measures are rmse, max, relmse, flip, share"),
        "{said}"
    );
}

#[test]
fn what_can_not_be_compared_is_told_and_no_map_appears() {
    let folder = pictures("png", &[]);
    let small = [
        "render",
        "ball.json",
        "-q",
        "--size",
        "20x15",
        "-o",
        "small.png",
    ];
    assert_eq!(code(&rtc(&folder, &small)), 0);
    assert_eq!(
        code(&rtc(
            &folder,
            &["render", "ball.json", "-q", "-o", "light.exr"]
        )),
        0
    );
    let whole = fs::read(folder.path().join("two.png")).unwrap();
    fs::write(folder.path().join("cut.png"), &whole[..whole.len() / 2]).unwrap();
    for (other, words) in [
        (
            "small.png",
            "`two.png` has 40 × 30 pixels, `small.png` 20 × 15",
        ),
        (
            "light.exr",
            "`light.exr` holds values of light, and `two.png` those of a display",
        ),
        ("cut.png", "`cut.png` is damaged"),
        ("ball.json", "`ball.json` is not a picture"),
        ("none.png", "`none.png`"),
    ] {
        let (code, told, said) = diff(&folder, &["two.png", other, "-o", "map.png"]);
        assert!(
            code == 2 && told.is_empty() && said.contains(words),
            "{other}: {said}"
        );
        assert!(!folder.path().join("map.png").exists());
    }
    let (code, _, said) = diff(&folder, &["one.png", "two.png", "-o", "two.png"]);
    assert!(
        code == 2 && said.contains("it is an input of this run"),
        "{said}"
    );
}
