//! A cache of cones and shafts of similar rays, each with the set of bounding spheres that its rays
//! may hit. The cache never decides a hit; it only removes shapes that no ray of the cone can hit.
//!
//! Cones: Amanatides, "Ray tracing with cones" (SIGGRAPH 1984). Shafts: Haines, Wallace, "Shaft
//! culling for efficient ray-cast radiosity" (1991).

mod four;

use crate::accel::bounds::BoundingSphere;
use crate::ray::Ray;
use arrayvec::ArrayVec;
use rtc_math::Vec3;

/// The greatest number of items, one bit each.
pub(crate) const MAX_ITEMS: usize = 64;

/// The margin, as a fraction of the coordinates it is for: 2⁻³², 2²¹ units of rounding. Hits are
/// accurate to about 10² units.
const MARGIN: f64 = 1.0 / 4_294_967_296.0;

/// The margin of sines: 2⁻²⁰. A cosine near 1 gives a sine to 10⁻⁸.
const SINE_MARGIN: f64 = 1.0 / 1_048_576.0;

/// The tolerance of the square of a direction's length.
const ONE: f64 = 1.0 / 1_073_741_824.0;

/// The widest cone, by its sine.
const WIDEST: f64 = 0.5;

/// The bounding spheres of a few items, each with a bit.
#[derive(Debug)]
pub(crate) struct BoundingSpheres {
    balls: Vec<(u64, BoundingSphere)>,
    /// The items without a sphere: every ray may hit them.
    unbounded: u64,
    /// All items.
    all: u64,
    /// The smallest radius, the measure of how near is near.
    smallest: f64,
}

impl BoundingSpheres {
    /// The spheres of some items by their bits, at most [`MAX_ITEMS`].
    pub(crate) fn new(items: impl Iterator<Item = (usize, Option<BoundingSphere>)>) -> Self {
        let (mut balls, mut smallest) = (Vec::new(), f64::INFINITY);
        let (mut unbounded, mut all) = (0, 0);
        for (bit, ball) in items {
            let bit = 1 << bit;
            all |= bit;
            match ball {
                Some(ball) => {
                    smallest = smallest.min(ball.radius);
                    balls.push((bit, ball));
                }
                None => unbounded |= bit,
            }
        }
        Self {
            balls,
            unbounded,
            all,
            smallest,
        }
    }

    /// The least of the given clearances that is at least `wanted`, or `wanted`, and the items with
    /// less than that.
    fn choose(&self, wanted: f64, floor: f64, clearances: &ArrayVec<f64, MAX_ITEMS>) -> (f64, u64) {
        let large = clearances.iter().filter(|clearance| **clearance >= wanted);
        let room = large.copied().reduce(f64::min).unwrap_or(wanted);
        let least = room.max(floor);
        let items = self.balls.iter().zip(clearances);
        let near = items.filter(|(_, clearance)| **clearance < least || clearance.is_nan());
        (
            room,
            near.fold(self.unbounded, |items, ((bit, _), _)| items | bit),
        )
    }
}

/// The width of the next cone: wider after a cone with few rays, narrower after one with many. It
/// changes the speed only, never the hits.
#[derive(Clone, Copy, Debug)]
struct ConeSizeHeuristic {
    uses: u32,
    /// The width, in radii of the smallest sphere.
    width: f64,
    /// The number of rays that still skip the cache, plus one; 0 while it is used.
    pause: u32,
}

impl ConeSizeHeuristic {
    const START: Self = Self {
        uses: Self::MIN_USES,
        width: 0.125,
        pause: 0,
    };

    /// A cone for fewer rays costs more than it saves rays that are tested four at a time.
    const MIN_USES: u32 = 16;

    /// The number of rays that skip the cache after a cone with few uses.
    const PAUSE: u32 = 64;

    fn next(self) -> Self {
        let width = match self.uses {
            0..8 => (self.width * 2.0).min(2.0),
            8..128 => self.width,
            _ => (self.width * 0.5).max(1.0 / 64.0),
        };
        Self {
            uses: 0,
            width,
            pause: 0,
        }
    }

    /// Whether the next `rays` rays skip the cache.
    #[inline(always)]
    fn pauses(&mut self, rays: u32) -> bool {
        if self.pause == 0 && self.uses < Self::MIN_USES {
            self.pause = Self::PAUSE;
        }
        let should_continue = self.pause > 1;
        if should_continue {
            self.pause -= rays.min(self.pause - 1);
        }
        should_continue
    }
}

/// All rays whose origins and directions differ little from those of one.
#[derive(Clone, Copy, Debug)]
struct RayCone {
    origin: Vec3,
    /// Of length 1.
    direction: Vec3,
    /// The largest squared distance of their origins; below 0 for no cone.
    near: f64,
    /// The largest squared distance of their directions.
    alike: f64,
    /// The items that they may hit.
    items: u64,
    pace: ConeSizeHeuristic,
}

impl RayCone {
    const EMPTY: Self = Self {
        origin: Vec3::ZERO,
        direction: Vec3::ZERO,
        near: -1.0,
        alike: -1.0,
        items: 0,
        pace: ConeSizeHeuristic::START,
    };

    #[inline(always)]
    fn holds(&self, ray: &Ray) -> bool {
        let (from, along) = (ray.origin - self.origin, ray.direction - self.direction);
        from.dot(from) <= self.near && along.dot(along) <= self.alike
    }

    /// A cone around a ray, of directions of length 1; `None` for other rays.
    #[inline(never)]
    fn around(&self, ray: &Ray, balls: &BoundingSpheres) -> Option<Self> {
        let length2 = ray.direction.dot(ray.direction);
        if !(ray.origin.is_finite() && (length2 - 1.0).abs() <= ONE) {
            return None;
        }
        let pace = self.pace.next();
        // Rays of a pinhole start at one point.
        let reach = if self.origin == ray.origin {
            0.0
        } else {
            pace.width * balls.smallest
        };
        let mut widest = WIDEST;
        let clearance = |(_, ball): &(u64, BoundingSphere)| {
            let (clearance, size) = cone_clearance(ray, reach, ball);
            widest = widest.min(size);
            clearance
        };
        let clearances = balls.balls.iter().map(clearance).collect();
        let (sine, items) = balls.choose(pace.width * widest, 0.0, &clearances);
        Some(Self {
            origin: ray.origin,
            direction: ray.direction,
            near: reach * reach,
            alike: sine * sine,
            items,
            pace,
        })
    }
}

/// The sine of the widest cone around a ray whose rays, from origins within `reach`, all miss a
/// sphere, below 0 if there is none; and how large the sphere is from there, about its sine.
///
/// At t those rays are within `reach + t·sine` of the one: they miss the sphere if the cone misses
/// the sphere grown by `reach`. As both are round, that depends on three angles alone.
fn cone_clearance(ray: &Ray, reach: f64, ball: &BoundingSphere) -> (f64, f64) {
    let f = ball.center - ray.origin;
    let size = (ray.origin.abs() + ball.center.abs()).element_sum() + ball.radius;
    let radius = ball.radius + reach + MARGIN * size;
    let along = f.dot(ray.direction);
    let beside = (f - ray.direction * along).length();
    let square = f.dot(f);
    let square_tangent = square - radius * radius;
    if square_tangent <= 0.0 || square_tangent.is_nan() {
        return (-1.0, WIDEST);
    }
    let tangent = square_tangent.sqrt();
    let seen = ball.radius / (tangent + ball.radius);
    // The angle between the axis and the nearest tangent of the sphere.
    let sine = (beside * tangent - along * radius) / square;
    let cosine = along * tangent + beside * radius;
    let clearance = if sine > 0.0 && cosine <= 0.0 {
        WIDEST
    } else {
        sine.min(WIDEST)
    };
    (
        clearance - SINE_MARGIN,
        if seen > 0.0 { seen } else { WIDEST },
    )
}

/// The segments from points near one another to points of a light.
#[derive(Clone, Copy, Debug)]
struct Shaft {
    light: usize,
    from: Vec3,
    /// The largest squared distance from there; below 0 for no cone.
    near: f64,
    /// The items that they may hit.
    items: u64,
    pace: ConeSizeHeuristic,
}

impl Shaft {
    const EMPTY: Self = Self {
        light: usize::MAX,
        from: Vec3::ZERO,
        near: -1.0,
        items: 0,
        pace: ConeSizeHeuristic::START,
    };

    #[inline(always)]
    fn holds(&self, light: usize, from: Vec3) -> bool {
        let step = from - self.from;
        self.light == light && step.dot(step) <= self.near
    }

    /// A shaft around the segment from a point to the centre of a light.
    #[inline(never)]
    fn around(
        &self,
        balls: &BoundingSpheres,
        light: usize,
        from: Vec3,
        target: &BoundingSphere,
    ) -> Self {
        let pace = self.pace.next();
        let clearance =
            |(_, ball): &(u64, BoundingSphere)| segment_clearance(from, target.center, ball);
        let clearances = balls.balls.iter().map(clearance).collect();
        let wanted = pace.width * balls.smallest;
        let (room, items) = balls.choose(wanted, target.radius, &clearances);
        Self {
            light,
            from,
            near: room * room,
            items,
            pace,
        }
    }
}

/// The clearance of a sphere from a segment: how far both ends may move without a hit. Below 0 if
/// the segment may hit the sphere.
fn segment_clearance(from: Vec3, to: Vec3, ball: &BoundingSphere) -> f64 {
    let (f, d) = (ball.center - from, to - from);
    let size = (from.abs() + to.abs() + ball.center.abs()).element_sum() + ball.radius;
    let nearest = (f.dot(d) / d.dot(d)).clamp(0.0, 1.0);
    (f - d * nearest).length() - ball.radius - MARGIN * size
}

/// Bounces that have cones of their own.
const LEVELS: usize = 8;

/// Cones of shadow rays kept at once.
const SHAFTS: usize = 32;

/// The cones under way: of rays by bounce, of shadow rays by bounce and light.
#[derive(Debug)]
pub(crate) struct RayConeCache {
    cones: [RayCone; LEVELS],
    shafts: [Shaft; SHAFTS],
}

impl RayConeCache {
    /// None yet.
    pub(crate) const EMPTY: Self = Self {
        cones: [RayCone::EMPTY; LEVELS],
        shafts: [Shaft::EMPTY; SHAFTS],
    };

    /// The items that a ray after this many bounces may hit; `None` if no cone contains the ray.
    #[inline(always)]
    pub(crate) fn along(
        &mut self,
        balls: &BoundingSpheres,
        bounce: usize,
        ray: &Ray,
    ) -> Option<u64> {
        let cone = &mut self.cones[bounce % LEVELS];
        if !cone.holds(ray) {
            *cone = cone.around(ray, balls)?;
        }
        cone.pace.uses += 1;
        Some(cone.items)
    }

    /// The items that may occlude a light, one of several, from a point after this many bounces.
    #[inline(always)]
    pub(crate) fn towards(
        &mut self,
        balls: &BoundingSpheres,
        [bounce, light, lights]: [usize; 3],
        from: Vec3,
        target: impl FnOnce() -> BoundingSphere,
    ) -> u64 {
        let shaft = self.shaft([bounce, light, lights]);
        if !shaft.holds(light, from) {
            *shaft = shaft.around(balls, light, from, &target());
        }
        shaft.pace.uses += 1;
        shaft.items
    }

    /// The cone of the shadow rays after this many bounces to a light, one of several. Late bounces
    /// share one if there are many lights.
    #[inline(always)]
    fn shaft(&mut self, [bounce, light, lights]: [usize; 3]) -> &mut Shaft {
        let levels = (SHAFTS / lights.max(1)).max(1);
        let slot = bounce.min(levels - 1) * lights + light;
        &mut self.shafts[slot % SHAFTS]
    }
}

#[cfg(test)]
mod tests;
