// Makes the seeds in KTX2: `npm install ktx2-encoder@0.6.0 && node ktx2.mjs corpus/image`. They are 10 × 6 pixels of known
// colors, in ETC1S and in UASTC, which src/image/decode/ktx2.rs tests.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { encodeToKTX2 } from "ktx2-encoder";

const [width, height] = [10, 6];
const TOP = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]];

function image(alpha) {
  const data = new Uint8Array(4 * width * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const block = Math.floor(x / 4);
      const below = block === 0 ? [255, 255, 255, alpha] : [99, 99, 99, 255];
      data.set(y < 4 ? TOP[block] : below, 4 * (y * width + x));
    }
  }
  return { data, width, height };
}

for (const [name, alpha, options] of [
  ["etc1s", 255, { isUASTC: false, qualityLevel: 255, compressionLevel: 5, isPerceptual: true, isSetKTX2SRGBTransferFunc: true }],
  ["etc1s-alpha", 102, { isUASTC: false, qualityLevel: 255, compressionLevel: 5 }],
  ["uastc", 102, { isUASTC: true, needSupercompression: false }],
  ["uastc-zstd", 102, { isUASTC: true, needSupercompression: true }],
]) {
  const imageDecoder = async () => image(alpha);
  const bytes = await encodeToKTX2(new Uint8Array(), { imageDecoder, generateMipmap: false, isKTX2File: true, ...options });
  writeFileSync(join(process.argv[2], `${name}.ktx2`), bytes);
}
