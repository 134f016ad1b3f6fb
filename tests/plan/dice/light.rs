//! Made-up emitters.

use super::Dice;
use rtc::ir::Emitter;

impl Dice {
    /// An emitter of any kind.
    pub(super) fn emitter(
        &mut self,
        position: [f64; 3],
        direction: [f64; 3],
        range: Option<f64>,
    ) -> Emitter {
        match self.roll(3) {
            0 => Emitter::Sun { direction },
            1 => Emitter::Point { position, range },
            _ => Emitter::Spot {
                position,
                direction,
                inner_angle: 0.1,
                outer_angle: self.pick(&[0.2, 0.5, 1.5]),
                range,
            },
        }
    }
    /// An emitter above the origin that shines down, more or less.
    pub(in super::super) fn emitter_above(&mut self) -> Emitter {
        let position = [self.number(1), self.number(1), self.pick(&[1.0, 1.5, 3.0])];
        let direction = [self.number(1), self.number(1), -1.5];
        let range = self.pick(&[None, Some(3.0)]);
        let mut emitter = self.emitter(position, direction, range);
        if let Emitter::Sun { direction } = &mut emitter {
            *direction = position;
        }
        emitter
    }
}
