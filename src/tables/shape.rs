//! The table of shapes. A shape is one row; each stage generates its enums and dispatch from the
//! rows.

/// Calls a macro with the table of shapes; all stages list them in its order.
///
/// A row holds the type, its name in snake case (the key in the IR is that in camel case), how
/// enums store it, and its values in one of two ways:
/// - `derived { value: rule "words"; … }`: a rule defines how each value is validated. The rules are
///   `point`; `direction`, of any length but 0; `step`, a direction with a length; `length`, above
///   0. The words name the value in a diagnostic.
/// - `custom { "value" … }`: the paths to the values in the IR; each stage has an `impl` for the
///   shape.
///
/// The macro is given all rows, with the paths to their values, and once more the `derived` ones:
/// `all { Type name Store ["value", …]; … } derived { Type name { value: …; … } … }`.
#[macro_export]
macro_rules! shapes {
    (@sorted $stage:ident [$($all:tt)*] [$($derived:tt)*]) => {
        $stage! { all { $($all)* } derived { $($derived)* } }
    };
    (@sorted $stage:ident [$($all:tt)*] [$($derived:tt)*]
        $(#[$doc:meta])* $Name:ident $name:ident $Store:ident custom { $($value:literal)* }
        $($rows:tt)*
    ) => {
        $crate::shapes! { @sorted $stage
            [$($all)* $(#[$doc])* $Name $name $Store [$($value),*];] [$($derived)*] $($rows)*
        }
    };
    (@sorted $stage:ident [$($all:tt)*] [$($derived:tt)*]
        $(#[$doc:meta])* $Name:ident $name:ident $Store:ident derived {
            $($value:ident: $rule:ident $($words:literal)?;)*
        }
        $($rows:tt)*
    ) => {
        $crate::shapes! { @sorted $stage
            [$($all)* $(#[$doc])* $Name $name $Store [$(stringify!($value)),*];]
            [$($derived)* $(#[$doc])* $Name $name {
                $($value: $rule $($words)?;)*
            }]
            $($rows)*
        }
    };
    ($stage:ident) => {
        $crate::shapes! { @sorted $stage [] []
            /// A sphere.
            Sphere sphere Inline custom { "center" "radius" }
            /// An infinite plane.
            Plane plane Inline derived {
                center: point;
                normal: direction "normal of a plane";
            }
            /// A triangle.
            Triangle triangle Inline custom { "vertices/0" "vertices/1" "vertices/2" }
            /// A quadrilateral.
            Quad quad Box custom { "vertices/0" "vertices/1" "vertices/2" "vertices/3" }
            /// A disc.
            Disc disc Inline derived {
                center: point;
                normal: direction "normal of a disc";
                radius: length "radius";
            }
            /// A cylinder with two caps.
            Cylinder cylinder Inline derived {
                base: point;
                axis: direction "axis of a cylinder";
                height: length "height";
                radius: length "radius";
            }
            /// A cone with a cap at its base.
            Cone cone Inline derived {
                base: point;
                up: step "height of a cone";
                radius: length "radius";
            }
            /// A paraboloid with a cap at its base.
            Paraboloid paraboloid Inline derived {
                base: point;
                up: step "height of a paraboloid";
                radius: length "radius";
            }
            /// A torus.
            Torus torus Inline derived {
                center: point;
                axis: direction "axis of a torus";
                major: length "radius";
                minor: length "radius of the tube";
            }
            /// A mesh, placed.
            Instance instance Box custom { "mesh" "worldFromObject" }
            /// An ellipsoid.
            Ellipsoid ellipsoid Box custom { "center" "axes" }
            /// A cylinder without ends.
            InfiniteCylinder infinite_cylinder Inline derived {
                center: point;
                axis: direction "axis of a cylinder";
                radius: length "radius";
            }
            /// A CSG solid.
            Csg csg Box custom { "operands" }
        }
    };
}
