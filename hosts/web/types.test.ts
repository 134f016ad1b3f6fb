// Only its types are checked: what the package gives has the types that it says.
import { type Finding, type Picture, type Scene, load } from "./dist/package/index.js";

export async function thumbnail(bytes: Uint8Array): Promise<Uint8Array> {
  const scene: Scene = await load("model.glb", bytes);
  const findings: Finding[] = await scene.check();
  const worst: "error" | "warning" | "note" | undefined = findings[0]?.severity;
  const line: number | null | undefined = findings[0]?.place?.line;
  const picture: Picture = await scene.render({ width: 64, height: 64, set: { tone: '"agx"' } });
  // @ts-expect-error: there is no such setting
  await scene.render({ widht: 64 });
  console.log(worst, line, picture.linear[0]);
  return picture.png;
}
