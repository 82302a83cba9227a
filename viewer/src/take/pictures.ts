// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { applyPalette, GIFEncoder, quantize } from "gifenc";
import { element } from "../dom";
import { emptyGrid, type GridFrame, readCounts, readGrid } from "../messages/grids";
import type { Stream } from "../stream/stream";
import type { ArrayDescription } from "../suit";
import { shownOf } from "../views/array/feeds";
import { FORCE, RAW } from "../views/array/quantities";
import { drawPicture, highest, pictureSize, roundEnd } from "./frame_picture";

const FRAME_MS = 100;
const MOST_COLORS = 256;
const PATIENCE_MS = 5000;

/** A finished picture. */
export interface Picture {
  blob: Blob;
  /** Time of the last frame. */
  stampS: number;
}

interface Source {
  topic: string;
  unit: string;
  /** The end of the scale is at least this: noise alone looks like nothing. */
  leastEnd: number;
  read: (message: DataView, frame: GridFrame) => void;
  /** A place in QUANTITIES. */
  quantity: number;
}

function sourceOf({ name, calibrated }: ArrayDescription): Source {
  return calibrated
    ? { topic: `/${name}/force`, unit: "N", leastEnd: 1, read: readGrid, quantity: FORCE }
    : { topic: `/${name}/raw`, unit: "counts", leastEnd: 100, read: readCounts, quantity: RAW };
}

/** Frames of an array as they come, every tenth of a second. Equal frames are kept once. */
async function collect(stream: Stream, array: ArrayDescription, source: Source, seconds: number): Promise<GridFrame[]> {
  const { topic, read, quantity } = source;
  const frames: GridFrame[] = [];
  let newest: DataView | undefined;
  const end = stream.subscribe(topic, (message) => (newest = message));
  newest ??= stream.latest(topic);
  const beganMs = performance.now();
  try {
    for (;;) {
      if (newest !== undefined) {
        const frame = emptyGrid();
        read(newest, frame);
        frame.values.set(shownOf(quantity, frame, array));
        frames.push(frame);
      }
      const passedMs = performance.now() - beganMs;
      if (frames.length > 0 && passedMs >= 1000 * seconds) return frames;
      if (frames.length === 0 && passedMs > PATIENCE_MS) throw new Error("No frame came.");
      await new Promise((resolve) => window.setTimeout(resolve, FRAME_MS));
    }
  } finally {
    end();
  }
}

function canvasFor(frame: GridFrame): [HTMLCanvasElement, CanvasRenderingContext2D] {
  const [width, height] = pictureSize(frame);
  const canvas = element("canvas", { width, height });
  const context = canvas.getContext("2d", { willReadFrequently: true });
  if (context === null) throw new Error("This browser draws no pictures.");
  return [canvas, context];
}

/** The newest frame as PNG. */
export async function takePicture(stream: Stream, array: ArrayDescription): Promise<Picture> {
  const source = sourceOf(array);
  const frame = (await collect(stream, array, source, 0)).at(-1)!;
  const [canvas, context] = canvasFor(frame);
  drawPicture(context, {
    array: array.name,
    unit: source.unit,
    end: roundEnd(Math.max(source.leastEnd, highest(frame))),
    frame,
  });
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/png"));
  if (blob === null) throw new Error("The picture is too large for this browser.");
  return { blob, stampS: frame.stampS };
}

/** The frames of the next seconds as a moving picture, with one scale for all. */
export async function takeFilm(stream: Stream, array: ArrayDescription, seconds: number): Promise<Picture> {
  const source = sourceOf(array);
  const frames = await collect(stream, array, source, seconds);
  const [canvas, context] = canvasFor(frames[0]!);
  const end = roundEnd(Math.max(source.leastEnd, ...frames.map(highest)));
  const film = GIFEncoder();
  for (const frame of frames) {
    drawPicture(context, { array: array.name, unit: source.unit, end, frame });
    const { data, width, height } = context.getImageData(0, 0, canvas.width, canvas.height);
    const palette = quantize(data, MOST_COLORS);
    film.writeFrame(applyPalette(data, palette), width, height, { palette, delay: FRAME_MS });
  }
  film.finish();
  return { blob: new Blob([film.bytes()], { type: "image/gif" }), stampS: frames.at(-1)!.stampS };
}
