//! Examples of stages of USD.

use super::ExamplePart;

const STAGE: &str = "#usda 1.0\n(\n    upAxis = \"Y\"\n    metersPerUnit = 1\n)\n";

pub(super) const PARTS: &[ExamplePart] = &[
    ExamplePart {
        title: "layers",
        before: &["#usda 1.0\n"],
        after: "\n",
        examples: &[
            (
                "`subLayers`",
                "(\n subLayers = [ @a.usda@ ]\n)\ndef Sphere \"s\" {}",
            ),
            (
                "`upAxis`, `metersPerUnit`",
                "(\n upAxis = \"Z\"\n metersPerUnit = 0.01\n)\ndef Sphere \"s\" {}",
            ),
            (
                "`references`",
                "def \"s\" (\n references = @a.usda@\n)\n{\n}",
            ),
            ("`payload`", "def \"s\" (\n payload = @a.usda@\n)\n{\n}"),
            (
                "`inherits`",
                "class Sphere \"c\" {\n double radius = 2\n}\n\
                 def Sphere \"s\" (\n inherits = </c>\n)\n{\n}",
            ),
            (
                "`specializes`",
                "class Sphere \"c\" {\n double radius = 2\n}\n\
                 def Sphere \"s\" (\n specializes = </c>\n)\n{\n}",
            ),
            (
                "`variantSets`",
                "def Sphere \"s\" (\n variants = { string v = \"x\" }\n variantSets = \"v\"\n)\n\
                 {\n variantSet \"v\" = {\n \"x\" { double radius = 2 }\n }\n}",
            ),
            (
                "a reference that leads nowhere",
                "def \"s\" (\n references = @a.usda@</nothing>\n)\n{\n}",
            ),
        ],
    },
    ExamplePart {
        title: "prims",
        before: &[STAGE],
        after: "\n",
        examples: &[
            ("`Sphere`", "def Sphere \"s\" {}"),
            ("`Cube`", "def Cube \"s\" {}"),
            ("`Cylinder`", "def Cylinder \"s\" {}"),
            ("`Cone`", "def Cone \"s\" {}"),
            ("`Capsule`", "def Capsule \"s\" {}"),
            ("`Plane`", "def Plane \"s\" {}"),
            (
                "`Mesh`, `none`",
                "def Mesh \"s\" {\n uniform token subdivisionScheme = \"none\"\n\
                 point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n\
                 int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2]\n}",
            ),
            (
                "`Mesh`, `catmullClark`",
                "def Mesh \"s\" {\n uniform token subdivisionScheme = \"catmullClark\"\n\
                 point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n\
                 int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2]\n}",
            ),
            (
                "`primvars:displayColor`",
                "def Sphere \"s\" {\n color3f[] primvars:displayColor = [(1, 0, 0)]\n}",
            ),
            (
                "`xformOp:translate`, `rotateXYZ`, `scale`",
                "def Sphere \"s\" {\n double3 xformOp:translate = (1, 0, 0)\n\
                 float3 xformOp:rotateXYZ = (10, 20, 30)\n float3 xformOp:scale = (2, 2, 2)\n\
                 uniform token[] xformOpOrder = [\"xformOp:translate\", \
                 \"xformOp:rotateXYZ\", \"xformOp:scale\"]\n}",
            ),
            (
                "`visibility`",
                "def Sphere \"s\" {\n token visibility = \"invisible\"\n}",
            ),
            (
                "`PointInstancer`",
                "def PointInstancer \"s\" {\n rel prototypes = [</s/p>]\n\
                 int[] protoIndices = [0]\n point3f[] positions = [(0, 0, 0)]\n\
                 def Sphere \"p\" {}\n}",
            ),
            (
                "`BasisCurves`",
                "def BasisCurves \"s\" {\n point3f[] points = [(0, 0, 0), (1, 0, 0)]\n\
                 int[] curveVertexCounts = [2]\n}",
            ),
            (
                "`Points`",
                "def Points \"s\" {\n point3f[] points = [(0, 0, 0)]\n}",
            ),
            ("`NurbsPatch`", "def NurbsPatch \"s\" {}"),
            ("`Volume`", "def Volume \"s\" {}"),
        ],
    },
    ExamplePart {
        title: "materials",
        // The stage of a ball with a material `m`, up to the kind of its shader.
        before: &[
            "#usda 1.0\n(\n upAxis = \"Y\"\n metersPerUnit = 1\n)\n",
            "def Sphere \"ball\" (\n prepend apiSchemas = [\"MaterialBindingAPI\"]\n)\n",
            "{\n rel material:binding = </m>\n}\n",
            "def Material \"m\"\n{\n token outputs:surface.connect = </m/s.outputs:surface>\n",
            " def Shader \"s\"\n {\n  uniform token info:id = ",
        ],
        after: "\n  token outputs:surface\n }\n}\n",
        examples: &[
            (
                "`UsdPreviewSurface`",
                "\"UsdPreviewSurface\"\n color3f inputs:diffuseColor = (1, 0, 0)\n\
                 float inputs:roughness = 0.3\n float inputs:metallic = 1",
            ),
            (
                "`clearcoat`",
                "\"UsdPreviewSurface\"\n float inputs:clearcoat = 1",
            ),
            (
                "`opacity`",
                "\"UsdPreviewSurface\"\n float inputs:opacity = 0.5",
            ),
            (
                "`useSpecularWorkflow`",
                "\"UsdPreviewSurface\"\n int inputs:useSpecularWorkflow = 1",
            ),
            (
                "`displacement`",
                "\"UsdPreviewSurface\"\n float inputs:displacement = 0.5",
            ),
            ("MaterialX", "\"ND_standard_surface_surfaceshader\""),
        ],
    },
    ExamplePart {
        title: "lights",
        before: &[STAGE],
        after: "\n",
        examples: &[
            (
                "`SphereLight`",
                "def SphereLight \"l\" {\n float inputs:intensity = 5\n}",
            ),
            ("`DiskLight`", "def DiskLight \"l\" {}"),
            ("`RectLight`", "def RectLight \"l\" {}"),
            (
                "`RectLight` with a texture",
                "def RectLight \"l\" {\n asset inputs:texture:file = @a.png@\n}",
            ),
            ("`CylinderLight`", "def CylinderLight \"l\" {}"),
            (
                "`DistantLight`",
                "def DistantLight \"l\" {\n float inputs:angle = 0\n}",
            ),
            (
                "`DistantLight` with an angle",
                "def DistantLight \"l\" {\n float inputs:angle = 10\n}",
            ),
            ("`DomeLight`", "def DomeLight \"l\" {}"),
            (
                "`DomeLight` with a texture",
                "def DomeLight \"l\" {\n asset inputs:texture:file = @sky.exr@\n}",
            ),
            (
                "`shaping:cone:angle`",
                "def SphereLight \"l\" (\n prepend apiSchemas = [\"ShapingAPI\"]\n)\n\
                 {\n float inputs:shaping:cone:angle = 30\n}",
            ),
            (
                "`enableColorTemperature`",
                "def SphereLight \"l\" {\n bool inputs:enableColorTemperature = 1\n\
                 float inputs:colorTemperature = 4000\n}",
            ),
            ("`PortalLight`", "def PortalLight \"l\" {}"),
            ("`GeometryLight`", "def GeometryLight \"l\" {}"),
        ],
    },
    ExamplePart {
        title: "cameras",
        before: &[STAGE],
        after: "\n",
        examples: &[
            (
                "`perspective`",
                "def Camera \"c\" {\n float focalLength = 35\n}",
            ),
            (
                "`orthographic`",
                "def Camera \"c\" {\n token projection = \"orthographic\"\n}",
            ),
            (
                "`fStop`",
                "def Camera \"c\" {\n float fStop = 2.8\n float focusDistance = 4\n}",
            ),
            (
                "`horizontalApertureOffset`",
                "def Camera \"c\" {\n float horizontalApertureOffset = 2\n}",
            ),
        ],
    },
];
