//! Anaglyphs: what both eyes of a stereoscopic camera see, in one picture for glasses with a red
//! filter on the left and a cyan one on the right.
//!
//! The colours are those that, seen through the filters, come closest to the two views: a least
//! squares projection of linear colours (Dubois, "A projection method to generate anaglyph stereo
//! images", ICASSP 2001; the matrices by the author, "Conversion of a stereo pair to anaglyph with
//! the least-squares projection method", 2009). Grey stays grey.

use super::Integrator;
use crate::camera::Camera;
use crate::film::RayCounts;
use crate::film::heartbeat::Heartbeat;
use crate::film::pixel::{PixelSample, SampleId};
use rtc_math::Vec3;

/// The rows of the matrices of the left and the right eye.
const DUBOIS: [[Vec3; 3]; 2] = [
    [
        Vec3::new(0.4561, 0.500484, 0.176381),
        Vec3::new(-0.040_082_2, -0.037_824_6, -0.015_758_9),
        Vec3::new(-0.015_216_1, -0.020_597_1, -0.005_468_56),
    ],
    [
        Vec3::new(-0.043_470_6, -0.087_938_8, -0.001_555_29),
        Vec3::new(0.378_476, 0.733_64, -0.018_450_3),
        Vec3::new(-0.072_152_7, -0.112_961, 1.2264),
    ],
];

/// An integrator of pictures as it is, or, for the camera of an anaglyph, one that sees by both
/// eyes.
pub(crate) fn for_eyes<'run: 'work, 'work>(
    camera: &Camera,
    integrator: impl Integrator<'run, Sample = PixelSample> + 'work,
) -> Box<dyn Integrator<'run, Sample = PixelSample> + 'work> {
    let integrator = Box::new(integrator);
    if !camera.is_anaglyph() {
        return integrator;
    }
    let right_begins = camera.size[0];
    Box::new(AnaglyphIntegrator {
        integrator,
        right_begins,
    })
}

/// Sees by both eyes with another integrator, whose images are side by side. Not generic, so that
/// integrators are compiled once.
struct AnaglyphIntegrator<'run, 'work> {
    integrator: Box<dyn Integrator<'run, Sample = PixelSample> + 'work>,
    /// The column where the image of the right eye begins.
    right_begins: u32,
}

impl<'run> Integrator<'run> for AnaglyphIntegrator<'run, '_> {
    type Sample = PixelSample;

    fn sample(&mut self, id: &SampleId) -> PixelSample {
        let [x, y] = id.pixel;
        let mut seen_from = |column| {
            let id = SampleId {
                pixel: [column, y],
                ..*id
            };
            self.integrator.begin(&id);
            self.integrator.sample(&id)
        };
        let views = [seen_from(x), seen_from(x + self.right_begins)];
        PixelSample {
            radiance: combined(views.map(|view| view.radiance)),
            hit: views.iter().any(|view| view.hit),
        }
    }

    fn counts(&self) -> &RayCounts {
        self.integrator.counts()
    }

    fn heartbeat(&mut self) -> &mut Heartbeat<'run> {
        self.integrator.heartbeat()
    }

    fn should_continue(&mut self) -> bool {
        self.integrator.should_continue()
    }
}

/// The most that a channel of the picture can change where what the eyes see changes by at most 1:
/// the greatest sum of the positive, or of the negative, factors of a channel.
pub(crate) fn gain() -> f64 {
    let sum = |k: usize, sign: f64| -> f64 {
        let factors = DUBOIS.iter().flat_map(|eye| eye[k].to_array());
        factors.map(|factor| (sign * factor).max(0.0)).sum()
    };
    let sums = (0..3).flat_map(|k| [1.0, -1.0].map(|sign| sum(k, sign)));
    sums.fold(0.0, f64::max)
}

/// The colour that shows two colours to two eyes.
fn combined(views: [Vec3; 2]) -> Vec3 {
    let channel = |k: usize| {
        let [left, right] = [0, 1].map(|eye| DUBOIS[eye][k].dot(views[eye]));
        left + right
    };
    Vec3::new(channel(0), channel(1), channel(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_stays_grey_and_each_eye_sees_its_own_channels() {
        let grey = combined([Vec3::splat(0.5); 2]);
        assert!(
            (grey - Vec3::splat(0.5)).abs().max_element() < 1e-5,
            "{grey}"
        );
        let left = combined([Vec3::ONE, Vec3::ZERO]);
        assert!(left.x > 1.0 && left.y < 0.0 && left.z < 0.0, "{left}");
        // The most that any colours bring: blue of the right eye alone.
        let blue = combined([Vec3::ZERO, Vec3::Z]).z;
        assert!((gain() - blue).abs() < 1e-12, "{}", gain());
        let right = combined([Vec3::ZERO, Vec3::ONE]);
        assert!(right.x < 0.0 && right.y > 1.0 && right.z > 1.0, "{right}");
    }
}
