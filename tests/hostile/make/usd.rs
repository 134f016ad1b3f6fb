//! Stages of USD that ask for much.

use super::Repro;

/// All of them.
pub(crate) fn all() -> Vec<Repro> {
    [
        texts(),
        paths(),
        arcs(),
        heirs(),
        geometry(),
        binary(),
        packages(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Texts that are no layers, or hardly.
fn texts() -> Vec<Repro> {
    vec![
        repeated("500 000 opening brackets", "[", 500_000, Some("US001")),
        repeated("500 000 quotes", "\"", 500_001, Some("US001")),
        repeated(
            "20 000 prims in each other",
            "def Xform \"a\" {\n",
            20_000,
            Some("US001"),
        ),
        repeated(
            "20 000 variants in each other",
            "variantSet \"s\" = { \"v\" {\n",
            20_000,
            Some("US001"),
        ),
        repeated("100 000 unknown words", "foo\n", 100_000, None),
        stage(
            "100 000 prims",
            numbered(100_000, |n| format!("def Xform \"p{n}\" {{}}\n")),
            None,
        ),
        stage(
            "a prim with 100 000 attributes",
            format!(
                "def Sphere \"s\" {{\n{}}}",
                numbered(100_000, |n| format!("float a{n} = 1\n"))
            ),
            None,
        ),
        stage(
            "a value in 500 000 brackets",
            format!(
                "def Sphere \"s\" {{ double radius = {}",
                "[".repeat(500_000)
            ),
            Some("US001"),
        ),
        stage(
            "metadata in 500 000 braces",
            format!(
                "def Sphere \"s\" ( customData = {} ) {{}}",
                "{".repeat(500_000)
            ),
            Some("US001"),
        ),
        stage("a comment of 2 MB", "#".repeat(2 << 20), None),
        stage(
            "a name of 2 MB",
            format!("def Fnord \"{}\" {{}}", "x".repeat(2 << 20)),
            None,
        ),
        stage(
            "an attribute with 300 000 samples",
            format!(
                "def Sphere \"s\" {{ double radius.timeSamples = {{ {} }} }}",
                numbered(300_000, |n| format!("{n}: 1, "))
            ),
            None,
        ),
        stage(
            "a stack of 100 000 operations",
            format!(
                "def Sphere \"s\" {{ double3 xformOp:translate = (0, 0, 0)\n\
                 uniform token[] xformOpOrder = [{}] }}",
                "\"xformOp:translate\", ".repeat(100_000)
            ),
            None,
        ),
    ]
}

/// Paths that are longer than what is there.
fn paths() -> Vec<Repro> {
    vec![
        stage(
            "a material 100 000 prims deep",
            format!(
                "def Sphere \"s\" {{ rel material:binding = <{}> }}",
                "/a".repeat(100_000)
            ),
            None,
        ),
        stage(
            "10 000 relative paths in a prim with a name of 1 MB",
            format!(
                "def \"{}\" {{\nrel target = [{}]\n}}",
                "n".repeat(1_000_000),
                "<a>, ".repeat(10_000)
            ),
            Some("IO003"),
        ),
    ]
}

/// Arcs that multiply, or never end.
fn arcs() -> Vec<Repro> {
    let doubling = (0..22).map(|level| {
        let next = format!(
            "#usda 1.0\n(\n defaultPrim = \"p\"\n)\ndef \"p\" {{\n\
             def \"a\" ( references = @{0}.usda@ ) {{}}\n\
             def \"b\" ( references = @{0}.usda@ ) {{}}\n}}",
            level + 1
        );
        (format!("{level}.usda"), next.into_bytes())
    });
    let last = b"#usda 1.0\n(\n defaultPrim = \"p\"\n)\ndef Sphere \"p\" {}".to_vec();
    let bomb = std::iter::once((
        "a.usda".to_owned(),
        text("def \"x\" ( references = @0.usda@ ) {}"),
    ))
    .chain(doubling)
    .chain([("22.usda".to_owned(), last)]);
    let within = (0..30).map(|n| {
        format!(
            "class \"c{n}\" ( inherits = [</c{0}>, </d{0}>] ) {{}}\n\
            class \"d{n}\" ( inherits = [</c{0}>, </d{0}>] ) {{}}\n",
            n + 1
        )
    });
    vec![
        Repro {
            name: "22 layers that refer to the next one twice",
            files: bomb.collect(),
            arguments: check(),
            expected: Some("IO003"),
        },
        stage(
            "30 levels of classes that inherit two",
            within.collect::<String>() + "def Sphere \"s\" ( inherits = </c0> ) {}",
            Some("IO003"),
        ),
        stage(
            "a prim that refers to the one around it",
            "def \"a\" { def \"b\" ( references = </a> ) {} }".to_owned(),
            None,
        ),
        stage(
            "two prims that hold references to each other",
            "def \"a\" { def \"b\" ( references = </c> ) {} }\n\
             def \"c\" { def \"d\" ( references = </a> ) {} }"
                .to_owned(),
            None,
        ),
        stage(
            "a layer beneath itself",
            "(\n subLayers = [@a.usda@]\n)\n".to_owned(),
            None,
        ),
        stage(
            "100 000 references to one prim",
            format!(
                "def Sphere \"s\" {{}}\ndef \"a\" ( references = [{}] ) {{}}",
                "</s>, ".repeat(100_000)
            ),
            Some("IO003"),
        ),
        stage(
            "30 000 layers that are not there",
            numbered(30_000, |n| {
                format!("def \"p{n}\" ( references = @{n}.usda@ ) {{}}\n")
            }),
            None,
        ),
        stage(
            "a chain of 30 000 connections",
            format!(
                "def Sphere \"s\" {{ rel material:binding = </m> }}\ndef Material \"m\" {{\n\
                 token outputs:surface.connect = </n0.outputs:o>\n}}\n{}",
                numbered(30_000, |n| format!(
                    "def Shader \"n{n}\" {{ token outputs:o.connect = </n{}.outputs:o> }}\n",
                    n + 1
                ))
            ),
            None,
        ),
    ]
}

/// What many prims inherit: the names at n, 2n and 4n, how many of each are too many, and the class.
struct Family {
    names: [&'static str; 3],
    too_many: usize,
    class: fn(usize) -> String,
}

const FAMILIES: [Family; 5] = [
    Family {
        names: [
            "500 prims that inherit 500 variants",
            "1 000 prims that inherit 1 000 variants",
            "2 000 prims that inherit 2 000 variants",
        ],
        too_many: 500,
        class: |count| {
            let chosen = numbered(count, |n| format!("string v{n} = \"a\"\n"));
            let sets = numbered(count, |n| {
                format!("variantSet \"v{n}\" = {{ \"a\" {{}} }}\n")
            });
            format!("class \"C\" ( variants = {{ {chosen} }} ) {{ {sets} }}\n")
        },
    },
    Family {
        names: [
            "500 prims that inherit 500 selections",
            "1 000 prims that inherit 1 000 selections",
            "2 000 prims that inherit 2 000 selections",
        ],
        too_many: usize::MAX,
        class: |count| {
            let chosen = numbered(count, |n| format!("string v{n} = \"a\"\n"));
            format!("class \"C\" ( variants = {{ {chosen} }} ) {{}}\n")
        },
    },
    Family {
        names: [
            "500 prims that inherit 500 operations",
            "1 000 prims that inherit 1 000 operations",
            "2 000 prims that inherit 2 000 operations",
        ],
        too_many: 2000,
        class: |count| {
            let order = "\"xformOp:translate\", ".repeat(count);
            format!(
                "class \"C\" {{ double3 xformOp:translate = (1, 1, 1)\n\
                 uniform token[] xformOpOrder = [{order}] }}\n"
            )
        },
    },
    Family {
        names: [
            "500 prims that inherit 500 bindings",
            "1 000 prims that inherit 1 000 bindings",
            "2 000 prims that inherit 2 000 bindings",
        ],
        too_many: 2000,
        class: |count| {
            let targets = numbered(count, |n| format!("</M{n}>, "));
            format!("class \"C\" {{ rel material:binding = [{targets}] }}\n")
        },
    },
    Family {
        names: [
            "500 prims that inherit 500 references",
            "1 000 prims that inherit 1 000 references",
            "2 000 prims that inherit 2 000 references",
        ],
        too_many: 500,
        class: |count| {
            let targets = numbered(count, |n| format!("</R{n}>, "));
            let prims = numbered(count, |n| format!("def \"R{n}\" {{}}\n"));
            format!("class \"C\" ( references = [{targets}] ) {{}}\n{prims}")
        },
    },
];

/// The families, and a layer that is named again.
fn heirs() -> Vec<Repro> {
    let mut repros = Vec::new();
    for family in FAMILIES {
        for (name, count) in family.names.into_iter().zip([500, 1000, 2000]) {
            let heirs = numbered(count, |n| {
                format!("def Sphere \"s{n}\" ( inherits = </C> ) {{}}\n")
            });
            let expected = (count >= family.too_many).then_some("IO003");
            repros.push(stage(name, (family.class)(count) + &heirs, expected));
        }
    }
    let again = [
        (500, "a layer of 1 000 prims that is named 500 times"),
        (1000, "a layer of 2 000 prims that is named 1 000 times"),
        (2000, "a layer of 4 000 prims that is named 2 000 times"),
    ];
    repros.extend(again.into_iter().map(|(names, name)| {
        let root = format!("(\n subLayers = [{}]\n)\n", "@b.usda@, ".repeat(names));
        let below = numbered(2 * names, |n| format!("def Sphere \"s{n}\" {{}}\n"));
        Repro {
            name,
            files: vec![
                ("a.usda".to_owned(), text(&root)),
                ("b.usda".to_owned(), text(&below)),
            ],
            arguments: check(),
            expected: None,
        }
    }));
    repros
}

/// Shapes that become many.
fn geometry() -> Vec<Repro> {
    let instancer = |inner: &str| {
        format!(
            "def PointInstancer \"i\" {{\nrel prototypes = [</i/p>]\nint[] protoIndices = [{}]\n\
             point3f[] positions = [{}]\ndef Xform \"p\" {{\n{inner}}}\n}}",
            "0, ".repeat(100_000),
            "(0, 0, 0), ".repeat(100_000)
        )
    };
    vec![
        stage(
            "100 000 instances of 1 000 spheres",
            instancer(&numbered(1_000, |n| format!("def Sphere \"s{n}\" {{}}\n"))),
            Some("IO003"),
        ),
        stage(
            "an instancer of itself",
            "def PointInstancer \"i\" {\nrel prototypes = [</i>]\nint[] protoIndices = [0]\n\
             point3f[] positions = [(0, 0, 0)]\n}"
                .to_owned(),
            None,
        ),
        stage(
            "a chain of 20 000 instancers",
            numbered(20_000, |n| nested(n, &format!("</i{}>", n + 1))),
            Some("IO003"),
        ),
        stage(
            "15 levels of instancers that have the next one 20 times",
            numbered(15, |n| nested(n, &format!("</i{}>, ", n + 1).repeat(20))) + "def \"i15\" {}",
            Some("IO003"),
        ),
        stage(
            "a mesh of indices beyond all points",
            "def Mesh \"m\" {\nint[] faceVertexCounts = [3]\n\
             int[] faceVertexIndices = [0, 1, 4000000000]\n\
             point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n}"
                .to_owned(),
            None,
        ),
        stage(
            "faces of more corners than numbers count",
            "def Mesh \"m\" {\n\
             int[] faceVertexCounts = [18446744073709551615, 18446744073709551615]\n\
             int[] faceVertexIndices = [0, 1, 2]\n\
             point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n}"
                .to_owned(),
            None,
        ),
        stage(
            "30 000 subsets of a face",
            format!(
                "def Mesh \"m\" {{\nint[] faceVertexCounts = [3]\n\
                 int[] faceVertexIndices = [0, 1, 2]\n\
                 point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n{}}}",
                numbered(30_000, |n| format!(
                    "def GeomSubset \"g{n}\" {{ int[] indices = [0]\n\
                     rel material:binding = </m{n}> }}\n"
                ))
            ),
            None,
        ),
        stage(
            "30 000 cones of their own",
            numbered(30_000, |n| {
                format!("def Cone \"c{n}\" {{ double height = {n} }}\n")
            }),
            Some("IO003"),
        ),
        stage(
            "numbers beyond all bounds",
            "def Sphere \"s\" { double radius = 1e308\n\
             double3 xformOp:scale = (1e308, 1e308, 1e308)\n\
             uniform token[] xformOpOrder = [\"xformOp:scale\"] }"
                .to_owned(),
            None,
        ),
    ]
}

/// An instancer of these prototypes.
fn nested(number: usize, prototypes: &str) -> String {
    format!(
        "def PointInstancer \"i{number}\" {{\nrel prototypes = [{prototypes}]\n\
         int[] protoIndices = [0]\npoint3f[] positions = [(0, 0, 0)]\n}}\n"
    )
}

/// 64-bit numbers as bytes.
fn words(numbers: &[u64]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

/// A block of LZ4 with its size: at most 14 bytes as they are.
fn literal(bytes: &[u8]) -> Vec<u8> {
    let mut block = vec![0, (bytes.len() as u8) << 4];
    block.extend(bytes);
    [words(&[block.len() as u64]), block].concat()
}

/// The bytes of a binary layer: its sections by name, one after the other.
fn crate_file(sections: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut bytes = b"PXR-USDC\0\x08\0\0\0\0\0\0".to_vec();
    let start = 88 + sections.iter().map(|(_, body)| body.len()).sum::<usize>();
    bytes.extend((start as u64).to_le_bytes());
    bytes.resize(88, 0);
    let mut places = Vec::new();
    for (_, body) in sections {
        places.push((bytes.len(), body.len()));
        bytes.extend(body);
    }
    bytes.extend((sections.len() as u64).to_le_bytes());
    for ((name, _), (start, length)) in sections.iter().zip(places) {
        let mut padded = [0; 16];
        padded[..name.len()].copy_from_slice(name.as_bytes());
        bytes.extend(padded);
        bytes.extend((start as u64).to_le_bytes());
        bytes.extend((length as u64).to_le_bytes());
    }
    bytes
}

fn binary() -> Vec<Repro> {
    let file = |name: &'static str, bytes: Vec<u8>, expected| Repro {
        name,
        files: vec![("a.usda".to_owned(), bytes)],
        arguments: check(),
        expected: Some(expected),
    };
    let many = [words(&[u64::MAX, 1 << 60, 9]), vec![0; 9]].concat();
    // One block of LZ4 that repeats a byte 16 million times.
    let mut block = vec![0, 0x1f, b'a', 1, 0];
    block.extend([255; 1 << 16]);
    block.push(0);
    let bomb = [words(&[1, 1 << 24, block.len() as u64]), block].concat();
    vec![
        file(
            "a binary layer that is cut off",
            b"PXR-USDC\0\x08".to_vec(),
            "US002",
        ),
        file("a binary layer without sections", crate_file(&[]), "US002"),
        file("10^18 tokens", crate_file(&[("TOKENS", many)]), "US002"),
        file(
            "tokens that unpack to 16 MB, and nothing else",
            crate_file(&[("TOKENS", bomb)]),
            "US002",
        ),
        file(
            "more paths than numbers count",
            crate_file(&[
                ("TOKENS", [words(&[1, 2]), literal(b"a\0")].concat()),
                ("STRINGS", words(&[0])),
                ("PATHS", [words(&[1, u64::MAX / 5, 1]), vec![0]].concat()),
            ]),
            "US002",
        ),
        file(
            "a binary layer of random bytes",
            crate_file(&[
                ("TOKENS", vec![0x5a; 4096]),
                ("STRINGS", vec![0x01; 64]),
                ("FIELDS", vec![0x77; 4096]),
                ("FIELDSETS", vec![0x33; 4096]),
                ("PATHS", vec![0x11; 4096]),
                ("SPECS", vec![0x99; 4096]),
            ]),
            "US002",
        ),
    ]
}

fn packages() -> Vec<Repro> {
    let entry = |name: &str, start: u32, size: u32| {
        let mut bytes = b"PK\x01\x02".to_vec();
        bytes.resize(20, 0);
        bytes.extend([size.to_le_bytes(), size.to_le_bytes()].concat());
        bytes.extend((name.len() as u16).to_le_bytes());
        bytes.resize(42, 0);
        bytes.extend(start.to_le_bytes());
        bytes.extend(name.as_bytes());
        bytes
    };
    let package = |name: &'static str, body: &[u8], entries: Vec<Vec<u8>>, expected| {
        let mut bytes = b"PK\x03\x04".to_vec();
        bytes.resize(26, 0);
        bytes.extend([6, 0, 0, 0]);
        bytes.extend(b"a.usda");
        bytes.extend(body);
        let start = bytes.len() as u32;
        bytes.extend(entries.concat());
        bytes.extend(b"PK\x05\x06");
        bytes.extend([0; 12]);
        bytes.extend(start.to_le_bytes());
        bytes.extend([0; 2]);
        Repro {
            name,
            files: vec![("a.usda".to_owned(), bytes)],
            arguments: check(),
            expected,
        }
    };
    let body = text("def Sphere \"s\" {}\ndef \"b\" ( references = @a.usda@</s> ) {}");
    let size = body.len() as u32;
    vec![
        package("a package without files", &body, Vec::new(), Some("US002")),
        package(
            "a package whose file is beyond its end",
            &body,
            vec![entry("a.usda", 0, u32::MAX)],
            Some("US002"),
        ),
        package(
            "a package of a layer that names itself",
            &body,
            vec![entry("a.usda", 0, size)],
            None,
        ),
        package(
            "a package with a list of 60 000 files",
            &body,
            (0..60_000)
                .map(|n| entry(&format!("{n}.usda"), 0, size))
                .collect(),
            Some("US002"),
        ),
    ]
}

fn check() -> Vec<String> {
    ["check", "-q", "a.usda"].map(str::to_owned).to_vec()
}

fn text(body: &str) -> Vec<u8> {
    format!("#usda 1.0\n{body}").into_bytes()
}

fn stage(name: &'static str, body: String, expected: Option<&'static str>) -> Repro {
    Repro {
        name,
        files: vec![("a.usda".to_owned(), text(&body))],
        arguments: check(),
        expected,
    }
}

fn repeated(name: &'static str, word: &str, times: usize, expected: Option<&'static str>) -> Repro {
    stage(name, word.repeat(times), expected)
}

fn numbered(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(line).collect()
}
