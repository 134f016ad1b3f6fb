//! Random emitters.

use super::Dice;
use rtc::internals::ir::{Photometry, PunctualKind};

impl Dice {
    /// An emitter of any kind.
    pub(super) fn emitter(
        &mut self,
        position: [f64; 3],
        direction: [f64; 3],
        range: Option<f64>,
    ) -> PunctualKind {
        match self.roll(4) {
            0 => PunctualKind::Sun { direction },
            1 => PunctualKind::Point { position, range },
            2 => PunctualKind::Photometric {
                position,
                direction,
                horizontal: self.pick(&[[1.0, 0.25, 0.125], [-2.0, 1.0, 0.5]]),
                photometry: Box::new(self.photometry()),
            },
            _ => PunctualKind::Spot {
                position,
                direction,
                inner_angle: 0.1,
                outer_angle: self.pick(&[0.2, 0.5, 1.5]),
                range,
            },
        }
    }
    /// A profile that is zero, uniform, or neither.
    fn photometry(&mut self) -> Photometry {
        let vertical = self.pick(&[&[0.0, 20.0, 45.0][..], &[0.0, 90.0], &[90.0, 120.0, 180.0]]);
        let horizontal = self.pick(&[&[0.0][..], &[0.0, 30.0, 180.0, 360.0]]);
        let candela = self.pick(&[&[0.0][..], &[1.0], &[2.0, 0.5, 0.0, 1.0]]);
        let count = vertical.len() * horizontal.len();
        Photometry {
            name: "lamp.ies".to_owned(),
            vertical: vertical.to_vec(),
            horizontal: horizontal.to_vec(),
            candela: candela.iter().copied().cycle().take(count).collect(),
        }
    }

    /// An emitter above the origin that points about downwards.
    pub(in super::super) fn emitter_above(&mut self) -> PunctualKind {
        let position = [self.number(1), self.number(1), self.pick(&[1.0, 1.5, 3.0])];
        let direction = [self.number(1), self.number(1), -1.5];
        let range = self.pick(&[None, Some(3.0)]);
        let mut emitter = self.emitter(position, direction, range);
        if let PunctualKind::Sun { direction } = &mut emitter {
            *direction = position;
        }
        emitter
    }
}
