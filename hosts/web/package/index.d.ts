import type { Effects, Finding, Findings, Settings } from "./rtc_web.js";

export type { Effect, Effects, Finding, Findings, Hint, Place, Settings, Severity, State } from "./rtc_web.js";

/** Why there is no scene or no picture. */
export class SceneError extends Error {
  /** The findings that explain it; may be empty. */
  readonly findings: Finding[];
}

/** A picture that was rendered. */
export interface Picture {
  /** Pixels. */
  readonly width: number;
  /** Pixels. */
  readonly height: number;
  /** Four bytes a pixel, as a canvas takes them. */
  readonly rgba: Uint8Array<ArrayBuffer>;
  /** Linear red, green and blue of each pixel. */
  readonly linear: Float32Array<ArrayBuffer>;
  /** The bytes of its PNG file, the same as those of `rtc render`. */
  readonly png: Uint8Array<ArrayBuffer>;
  /** The rays that it took. */
  readonly rays: number;
  /** Seconds in the worker. */
  readonly seconds: number;
  /** The root mean square error in grey levels (90 %); with `targetError` or `denoise`. */
  readonly error?: number;
  /** The findings of the scene and the picture. */
  readonly findings: Findings;
}

/** The progress of a render: the share that is done, from 0 to 1, and the rays so far. */
export interface Progress {
  readonly done: number;
  readonly rays: number;
}

/** A scene that was read. */
export interface Scene {
  /** All findings, in the order of the text. */
  check(options?: { signal?: AbortSignal }): Promise<Findings>;
  /** The effects that its picture needs, and those left out, each with the reason. */
  effects(settings?: Settings): Promise<Effects>;
  /** Its picture. An `AbortSignal` ends the render. */
  render(settings?: Settings, options?: { onProgress?: (progress: Progress) => void; signal?: AbortSignal }): Promise<Picture>;
  /** Ends its worker. */
  close(): void;
}

/** A file: its text or its bytes. */
export type Content = string | ArrayBuffer | ArrayBufferView;

/**
 * Reads a scene: the file at an address; a path with its text or bytes; or a path and all files, by their paths.
 * A path without a file fails with a `SceneError`; errors in a scene are among its findings, and fail its renders.
 */
export function load(
  path: string | URL,
  content?: Content | Map<string, Content> | Record<string, Content>,
  options?: { signal?: AbortSignal },
): Promise<Scene>;
