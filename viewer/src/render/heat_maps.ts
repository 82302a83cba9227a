// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { shaderSource } from "./color_map";

const VERTEX = `#version 300 es
precision highp sampler2D;
uniform bool discs;
uniform sampler2D places;
uniform ivec2 size;
out vec2 on_disc;
flat out int disc;
void main() {
  disc = gl_InstanceID;
  on_disc = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
  if (discs) {
    vec4 place = texelFetch(places, ivec2(disc % size.x, disc / size.x), 0);
    gl_Position = vec4((2.0 * (place.xy + on_disc * place.zw) - 1.0) * vec2(1.0, -1.0), 0.0, 1.0);
    return;
  }
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
uniform sampler2D values;
uniform usampler2D statuses;
uniform ivec2 size;
uniform vec4 area;
uniform float scale_end;
uniform bool interpolated;
uniform vec3 line;
uniform vec3 fault;
uniform vec3 fault_stripe;
uniform float pixel_ratio;
uniform bool discs;
uniform sampler2D places;
in vec2 on_disc;
flat in int disc;
out vec4 color;

${shaderSource()}

bool is_faulty(ivec2 taxel) {
  return texelFetch(statuses, taxel, 0).r > 2u;
}

// Faulty taxels have no say.
float between_taxels(vec2 place) {
  vec2 first = floor(place);
  vec2 share = place - first;
  float sum = 0.0;
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 taxel = clamp(ivec2(first) + step, ivec2(0), size - 1);
    vec2 near = mix(1.0 - share, share, vec2(step));
    float weight = is_faulty(taxel) ? 0.0 : near.x * near.y;
    sum += weight > 0.0 ? weight * texelFetch(values, taxel, 0).r : 0.0;
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

void main() {
  vec2 pixel = gl_FragCoord.xy - area.xy;
  pixel.y = area.w - pixel.y;
  vec2 cell_pixels = area.zw / vec2(size);
  vec2 place = pixel / cell_pixels;
  ivec2 taxel = clamp(ivec2(place), ivec2(0), size - 1);
  vec2 inside = (place - vec2(taxel)) * cell_pixels;
  if (discs) {
    if (length(on_disc) > 1.0) discard;
    taxel = ivec2(disc % size.x, disc / size.x);
    cell_pixels = 2.0 * texelFetch(places, taxel, 0).zw * area.zw;
    inside = (0.5 + 0.5 * on_disc) * cell_pixels;
  }
  uint status = texelFetch(statuses, taxel, 0).r;
  vec3 shade;
  if (status > 2u) {
    float stripe = mod(pixel.x + pixel.y, 7.0 * pixel_ratio);
    shade = stripe < 2.5 * pixel_ratio ? fault_stripe : fault;
  } else {
    float measured = texelFetch(values, taxel, 0).r;
    float smaller = min(cell_pixels.x, cell_pixels.y);
    shade = color_map((interpolated && !discs ? between_taxels(place - 0.5) : measured) / scale_end);
    bool on_dot = measured > scale_end && distance(inside, 0.5 * cell_pixels) < max(0.14 * smaller, pixel_ratio);
    bool on_corner = status > 0u && inside.x + inside.y < (discs ? 0.75 : 0.45) * smaller;
    if (on_dot || on_corner) shade = vec3(opposite(shade));
  }
  bool on_line = !interpolated && min(cell_pixels.x, cell_pixels.y) > 6.0 * pixel_ratio &&
                 min(inside.x, inside.y) < pixel_ratio;
  vec2 from_border = min(pixel, area.zw - pixel);
  bool on_border = min(from_border.x, from_border.y) < pixel_ratio;
  color = vec4(!discs && (on_line || on_border) ? mix(shade, line, 0.6) : shade, 1.0);
}`;

export type Rgb = readonly [number, number, number];

export interface HeatMapColors {
  line: Rgb;
  fault: Rgb;
  faultStripe: Rgb;
  /** An empty map is light. */
  fromLight: boolean;
}

/** Where a map is on the canvas, in CSS pixels. */
export interface Area {
  left: number;
  top: number;
  width: number;
  height: number;
}

interface Map {
  places: WebGLTexture;
  /** Taxels are discs at their places. */
  discs: boolean;
  values: WebGLTexture;
  statuses: WebGLTexture;
  rows: number;
  cols: number;
  area: Area;
  scaleEnd: number;
}

function compile(gl: WebGL2RenderingContext, type: GLenum, source: string): WebGLShader {
  const shader = gl.createShader(type)!;
  gl.shaderSource(shader, source);
  gl.compileShader(shader);
  return shader;
}

/** Is compiled and linked in the background, until something is asked of it. */
function link(gl: WebGL2RenderingContext): WebGLProgram {
  const program = gl.createProgram();
  gl.attachShader(program, compile(gl, gl.VERTEX_SHADER, VERTEX));
  gl.attachShader(program, compile(gl, gl.FRAGMENT_SHADER, FRAGMENT));
  gl.linkProgram(program);
  return program;
}

function checkLinked(gl: WebGL2RenderingContext, program: WebGLProgram): void {
  if (gl.getProgramParameter(program, gl.LINK_STATUS) || gl.isContextLost()) return;
  const logs = gl.getAttachedShaders(program)?.map((shader) => gl.getShaderInfoLog(shader)) ?? [];
  throw new Error(logs.find((log) => log) ?? gl.getProgramInfoLog(program) ?? "the shaders do not link");
}

const UNIFORMS = [
  "size",
  "area",
  "scale_end",
  "interpolated",
  "line",
  "fault",
  "fault_stripe",
  "pixel_ratio",
  "from_light",
  "discs",
] as const;
type Uniforms = Record<(typeof UNIFORMS)[number], WebGLUniformLocation | null>;

/** The program is in use then. */
function useProgram(gl: WebGL2RenderingContext, program: WebGLProgram): Uniforms {
  checkLinked(gl, program);
  gl.useProgram(program);
  gl.uniform1i(gl.getUniformLocation(program, "values"), 0);
  gl.uniform1i(gl.getUniformLocation(program, "statuses"), 1);
  gl.uniform1i(gl.getUniformLocation(program, "places"), 2);
  return Object.fromEntries(UNIFORMS.map((name) => [name, gl.getUniformLocation(program, name)])) as Uniforms;
}

/** Several heat maps on one canvas, drawn by one shader; each taxel as measured, or interpolated between them. */
export class HeatMaps {
  readonly canvas: HTMLCanvasElement;
  interpolated = false;
  readonly #gl: WebGL2RenderingContext;
  readonly #maps: Map[] = [];
  #program!: WebGLProgram;
  /** From the first map that is drawn on. */
  #uniforms: Uniforms | undefined;
  #colors: HeatMapColors = { line: [0, 0, 0], fault: [0.5, 0.5, 0.5], faultStripe: [0, 0, 0], fromLight: false };
  #pixelRatio = 1;

  constructor(canvas: HTMLCanvasElement, count: number, onRestored: () => void) {
    const gl = canvas.getContext("webgl2", { antialias: false, depth: false, stencil: false });
    if (gl === null) throw new Error("This browser shows no WebGL 2, which the maps are drawn with.");
    this.canvas = canvas;
    this.#gl = gl;
    this.#begin(count);
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => {
      this.#begin(count);
      onRestored();
    });
  }

  #begin(count: number): void {
    const gl = this.#gl;
    this.#program = link(gl);
    this.#uniforms = undefined;
    gl.bindVertexArray(gl.createVertexArray());
    gl.enable(gl.SCISSOR_TEST);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    const areas = this.#maps.splice(0).map(({ area, scaleEnd }) => ({ area, scaleEnd }));
    for (let index = 0; index < count; ++index) {
      this.#maps.push({
        places: this.#texture(),
        discs: false,
        values: this.#texture(),
        statuses: this.#texture(),
        rows: 0,
        cols: 0,
        area: areas[index]?.area ?? { left: 0, top: 0, width: 0, height: 0 },
        scaleEnd: areas[index]?.scaleEnd ?? 1,
      });
    }
  }

  #texture(): WebGLTexture {
    const gl = this.#gl;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    return texture;
  }

  setColors(colors: HeatMapColors): void {
    this.#colors = colors;
  }

  resize(width: number, height: number, pixelRatio: number): void {
    this.#pixelRatio = pixelRatio;
    this.canvas.width = Math.max(1, Math.round(width * pixelRatio));
    this.canvas.height = Math.max(1, Math.round(height * pixelRatio));
  }

  place(index: number, area: Area): void {
    this.#maps[index]!.area = area;
  }

  /** Discs of taxels in no grid, each x, y and the two radii as shares of the map; empty: taxels are cells of a grid. */
  setPlaces(index: number, cols: number, places: Float32Array): void {
    const gl = this.#gl;
    const map = this.#maps[index]!;
    map.discs = places.length > 0;
    if (!map.discs) return;
    gl.activeTexture(gl.TEXTURE2);
    gl.bindTexture(gl.TEXTURE_2D, map.places);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, cols, places.length / 4 / cols, 0, gl.RGBA, gl.FLOAT, places);
  }

  setScale(index: number, end: number): void {
    this.#maps[index]!.scaleEnd = end;
  }

  /** Nothing is drawn of it until it has values again. */
  clear(index: number): void {
    this.#maps[index]!.rows = 0;
  }

  setValues(index: number, rows: number, cols: number, values: Float32Array, statuses: Uint8Array): void {
    const gl = this.#gl;
    const map = this.#maps[index]!;
    const isNew = map.rows !== rows || map.cols !== cols;
    map.rows = rows;
    map.cols = cols;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, map.values);
    if (isNew) gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32F, cols, rows, 0, gl.RED, gl.FLOAT, values);
    else gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, cols, rows, gl.RED, gl.FLOAT, values);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, map.statuses);
    if (isNew) gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8UI, cols, rows, 0, gl.RED_INTEGER, gl.UNSIGNED_BYTE, statuses);
    else gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, cols, rows, gl.RED_INTEGER, gl.UNSIGNED_BYTE, statuses);
  }

  draw(): void {
    const gl = this.#gl;
    const { line, fault, faultStripe, fromLight } = this.#colors;
    gl.scissor(0, 0, this.canvas.width, this.canvas.height);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const maps = this.#maps.filter(({ rows, area }) => rows > 0 && area.width > 0);
    if (maps.length === 0) return;
    this.#uniforms ??= useProgram(gl, this.#program);
    const uniforms = this.#uniforms;
    gl.uniform1i(uniforms.interpolated, this.interpolated ? 1 : 0);
    gl.uniform1f(uniforms.pixel_ratio, this.#pixelRatio);
    gl.uniform1i(uniforms.from_light, fromLight ? 1 : 0);
    gl.uniform3f(uniforms.line, line[0], line[1], line[2]);
    gl.uniform3f(uniforms.fault, fault[0], fault[1], fault[2]);
    gl.uniform3f(uniforms.fault_stripe, faultStripe[0], faultStripe[1], faultStripe[2]);
    for (const map of maps) this.#drawMap(map, uniforms);
  }

  #drawMap({ places, discs, values, statuses, rows, cols, area, scaleEnd }: Map, uniforms: Uniforms): void {
    const gl = this.#gl;
    const left = Math.round(area.left * this.#pixelRatio);
    const width = Math.round(area.width * this.#pixelRatio);
    const height = Math.round(area.height * this.#pixelRatio);
    const bottom = this.canvas.height - Math.round(area.top * this.#pixelRatio) - height;
    gl.viewport(left, bottom, width, height);
    gl.scissor(left, bottom, width, height);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, values);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, statuses);
    gl.activeTexture(gl.TEXTURE2);
    gl.bindTexture(gl.TEXTURE_2D, places);
    gl.uniform1i(uniforms.discs, discs ? 1 : 0);
    gl.uniform2i(uniforms.size, cols, rows);
    gl.uniform4f(uniforms.area, left, bottom, width, height);
    gl.uniform1f(uniforms.scale_end, scaleEnd);
    if (discs) gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, rows * cols);
    else gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}
