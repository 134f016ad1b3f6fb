# The ends of a conservative ray (ConservativeRay::t_far, ConservativeRay::t_certain): a root may be wrong by 2^-21 of itself, and the one end
# still lies beyond it, the other before it.
#
# from src/render/accel/conservative_ray.rs: end as f32 * (1.0 + {UP} * f32::EPSILON) + self.error
# from src/render/accel/conservative_ray.rs: end as f32 * (1.0 - {DOWN} * f32::EPSILON) - 2.0 * self.error
# from src/render/accel/conservative_ray.rs: const T_SLACK: f64 = 1.0 / {ROUNDED};
#
# end is t_max * rate * (1 + or - ROUNDED) - start. With a = t_max * rate, and d the exact end for a root
# wrong by 2^-21, it is a * more + d or d - a * less, times a rounding, as a * more and a * less are
# not negative. What the conservative ray's error adds is only more room. Roundings of f64 are factors 1 + g,
# of f32 1 + e.
UP = 2;
DOWN = 4;
ROUNDED = 1048576;
u = 1b-24;
root = 1b-21;

more = (1 + g1) * (1 + 1 / ROUNDED) * (1 + g2) - (1 + root);
less = (1 - root) - (1 + g1) * (1 - 1 / ROUNDED) * (1 + g2);
up = (1 + g3) * (1 + e1) * (1 + UP * 2 * u) * (1 + e2) * (1 + e3);
down = (1 + g3) * (1 + e1) * (1 - DOWN * 2 * u) * (1 + e2) * (1 + e3);

{ |g1| <= 1b-53 /\ |g2| <= 1b-53 /\ |g3| <= 1b-53
  /\ |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24
  -> more >= 0 /\ less >= 0 /\ up >= 1 /\ down <= 1 }
