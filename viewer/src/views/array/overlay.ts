// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { measured } from "../../format";
import { SLOTS, type Trail } from "../../live/contact_slots";
import type { ArrayLive } from "../../live/live_data";
import { type Region, regionName } from "../../live/region_force";
import type { Contact } from "../../messages/contacts";
import type { Area } from "../../render/heat_maps";
import type { ArrayDescription } from "../../suit";
import { cssColor } from "../../theme";
import { type Standing, spread } from "../spread";
import { boundsOf, boxOf, cellOf, LABEL_MARGIN, pointOn } from "./geometry";

const TURN = 2 * Math.PI;
const CENTRE_PIXELS = 7;
const LABEL_HEIGHT = 18;
const LABEL_GAP = 12;
const HALO = "rgb(0 0 0 / 70%)";
const INK = "#ffffff";
const FONT = '600 12px "Inter", "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", Arial, sans-serif';

/** The marks over the maps; undefined ones are not drawn. */
export interface Marks {
  /** The map of forces or pressures, which alone has contacts and their centre. */
  readonly load: Area;
  readonly contacts: ArrayLive | undefined;
  /** Those of the frame that the map shows. */
  readonly touching: readonly Contact[];
  readonly centre: Trail | undefined;
  readonly region: Region | undefined;
  /** -1: nowhere. */
  readonly cursor: number;
  readonly pins: readonly number[];
}

/** From metres in the plane of an array to pixels on a map of it. */
interface Scale {
  readonly originX: number;
  readonly originY: number;
  readonly pixelsX: number;
  readonly pixelsY: number;
}

/** The label of a contact that is drawn at x and y. */
interface ContactLabel extends Standing {
  readonly contact: Contact;
  readonly color: string;
  readonly x: number;
  readonly y: number;
}

function labelText({ id, forceN, sigmaForceN }: Contact): string {
  return `#${id}  ${measured(forceN, sigmaForceN)[0]} N`;
}

function scaleOf(area: Area, array: ArrayDescription): Scale {
  const [originX, originY] = pointOn(area, array, 0, 0);
  const pixels = array.places && area.width / boundsOf(array.places).width;
  return {
    originX,
    originY,
    pixelsX: pixels ?? area.width / (array.cols * array.pitch_m[1]),
    pixelsY: pixels ?? area.height / (array.rows * array.pitch_m[0]),
  };
}

/** Draws contacts with their trails, the centre of pressure, a region, cursor and pins. */
export class Overlay {
  readonly canvas: HTMLCanvasElement;
  readonly #pen: CanvasRenderingContext2D;
  #seriesColors: string[] = [];
  #text = "";
  /** Round what is in the colours of contacts. */
  #rim = "";

  constructor(canvas: HTMLCanvasElement) {
    this.canvas = canvas;
    this.#pen = canvas.getContext("2d")!;
  }

  readColors(): void {
    this.#seriesColors = Array.from({ length: SLOTS }, (_, index) => cssColor(`--series-${index + 1}`));
    this.#text = cssColor("--text");
    this.#rim = cssColor("--surface");
  }

  resize(width: number, height: number, pixelRatio: number): void {
    this.canvas.width = Math.round(width * pixelRatio);
    this.canvas.height = Math.round(height * pixelRatio);
    this.#pen.setTransform(pixelRatio, 0, 0, pixelRatio, 0, 0);
  }

  draw(
    areas: readonly Area[],
    array: ArrayDescription,
    { load, contacts, touching, centre, region, cursor, pins }: Marks,
  ): void {
    this.#pen.save();
    this.#pen.resetTransform();
    this.#pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    this.#pen.restore();
    for (const area of areas) {
      if (area.width === 0) continue;
      pins.forEach((taxel, index) => this.#drawPin(area, array, taxel, index + 1));
      if (cursor >= 0) this.#drawCursor(area, array, cursor);
      if (region?.array === array.name) this.#drawRegion(area, array, region);
    }
    if (load.width === 0) return;
    if (contacts !== undefined) this.#drawContacts(load, array, contacts, touching);
    if (centre !== undefined && array.places === undefined) this.#drawCentre(centre, scaleOf(load, array));
  }

  #drawRegion(area: Area, array: ArrayDescription, region: Region): void {
    const { left, top, width, height } = boxOf(area, array, region.rows, region.cols);
    const pen = this.#pen;
    pen.setLineDash([7, 4]);
    this.#strokeTwice(() => pen.strokeRect(left, top, width, height), 2);
    pen.setLineDash([]);
    pen.font = FONT;
    pen.textAlign = "left";
    pen.textBaseline = "bottom";
    this.#textTwice(regionName(region), left + 4, top + height - 3);
  }

  /** A cross in a ring, and the way that led there. */
  #drawCentre(trail: Trail, { originX, originY, pixelsX, pixelsY }: Scale): void {
    if (trail.length === 0) return;
    const pen = this.#pen;
    const x = (point: number): number => originX + trail.x(point) * pixelsX;
    const y = (point: number): number => originY + trail.y(point) * pixelsY;
    pen.beginPath();
    for (let point = 0; point < trail.length; ++point) pen.lineTo(x(point), y(point));
    this.#strokeTwice(() => pen.stroke(), 1.5);
    const [endX, endY] = [x(trail.length - 1), y(trail.length - 1)];
    pen.beginPath();
    pen.arc(endX, endY, CENTRE_PIXELS, 0, TURN);
    for (const [dx, dy] of [
      [CENTRE_PIXELS, 0],
      [0, CENTRE_PIXELS],
    ] as const) {
      pen.moveTo(endX - 1.6 * dx, endY - 1.6 * dy);
      pen.lineTo(endX + 1.6 * dx, endY + 1.6 * dy);
    }
    this.#strokeTwice(() => pen.stroke(), 2);
  }

  #drawCursor(area: Area, array: ArrayDescription, taxel: number): void {
    const { left, top, width, height } = cellOf(area, array, taxel);
    this.#strokeTwice(() => this.#pen.strokeRect(left + 0.5, top + 0.5, width, height), 1.5);
  }

  #drawPin(area: Area, array: ArrayDescription, taxel: number, label: number): void {
    const { left, top, width, height } = cellOf(area, array, taxel);
    const pen = this.#pen;
    pen.setLineDash([3, 2]);
    this.#strokeTwice(() => pen.strokeRect(left + 1, top + 1, width - 1, height - 1), 1);
    pen.setLineDash([]);
    if (Math.min(width, height) < 14) return;
    pen.font = FONT;
    pen.textAlign = "left";
    pen.textBaseline = "top";
    this.#textTwice(String(label), left + 3, top + 2);
  }

  /** Rings on the map, and their labels beside it, all in the colours of the table. */
  #drawContacts(area: Area, array: ArrayDescription, live: ArrayLive, touching: readonly Contact[]): void {
    const { originX, originY, pixelsX, pixelsY } = scaleOf(area, array);
    const pen = this.#pen;
    const labels = touching.map((contact) => {
      const [x, y] = pointOn(area, array, contact.x, contact.y);
      const slot = live.slots.indexOf(contact.id);
      const color = this.#seriesColors[slot] ?? this.#text;
      return { contact, slot, color, x, y, top: y - 0.5 * LABEL_HEIGHT, height: LABEL_HEIGHT };
    });
    pen.save();
    pen.beginPath();
    pen.rect(area.left, area.top, area.width, area.height);
    pen.clip();
    for (const { contact, slot, color, x, y } of labels) {
      if (array.places === undefined) this.#drawTrail(live, slot, color, { originX, originY, pixelsX, pixelsY });
      this.#drawOutline(contact, color, x, y, pixelsX, pixelsY);
    }
    pen.restore();
    for (const label of spread(labels, area.top, area.top + area.height)) this.#drawLabel(label, area);
  }

  #drawTrail(live: ArrayLive, slot: number, color: string, { originX, originY, pixelsX, pixelsY }: Scale): void {
    const trail = live.slots.slots[slot]?.trail;
    if (trail === undefined || trail.length < 2) return;
    const pen = this.#pen;
    for (let point = 1; point < trail.length; ++point) {
      pen.globalAlpha = (0.7 * point) / trail.length;
      pen.beginPath();
      pen.moveTo(originX + trail.x(point - 1) * pixelsX, originY + trail.y(point - 1) * pixelsY);
      pen.lineTo(originX + trail.x(point) * pixelsX, originY + trail.y(point) * pixelsY);
      this.#strokeTwice(() => pen.stroke(), 1.25, color);
    }
    pen.globalAlpha = 1;
  }

  /** An ellipse of the area of the contact, in its proportions; inside, where it is with 95 %: two sigmas. */
  #drawOutline(contact: Contact, color: string, x: number, y: number, pixelsX: number, pixelsY: number): void {
    const pen = this.#pen;
    const slenderness = contact.minorAxisM > 0 ? Math.min(4, contact.majorAxisM / contact.minorAxisM) : 1;
    const major = Math.sqrt((contact.areaM2 / Math.PI) * slenderness) * pixelsX;
    const minor = Math.sqrt(contact.areaM2 / Math.PI / slenderness) * pixelsY;
    const ellipse = (radiusX: number, radiusY: number, angle: number): void => {
      pen.beginPath();
      pen.ellipse(x, y, Math.max(1, radiusX), Math.max(1, radiusY), angle, 0, TURN);
      pen.stroke();
    };
    this.#strokeTwice(() => ellipse(major, minor, contact.angleRad), 2, color);
    this.#strokeTwice(() => ellipse(2 * contact.sigmaX * pixelsX, 2 * contact.sigmaY * pixelsY, 0), 1.5, color);
  }

  /** In the margin at the right of the map, with a line to its contact. */
  #drawLabel({ contact, color, x, y, top }: ContactLabel, area: Area): void {
    const pen = this.#pen;
    const left = area.left + area.width + LABEL_GAP;
    const middle = top + 0.5 * LABEL_HEIGHT;
    pen.beginPath();
    pen.moveTo(left, middle);
    pen.lineTo(area.left + area.width + 3, middle);
    pen.lineTo(x, y);
    pen.strokeStyle = color;
    pen.lineWidth = 1;
    pen.stroke();
    pen.fillStyle = color;
    pen.fillRect(left, top + 1, 4, LABEL_HEIGHT - 2);
    pen.font = FONT;
    pen.textAlign = "left";
    pen.textBaseline = "middle";
    pen.fillText(labelText(contact), left + 8, middle + 0.5, LABEL_MARGIN - LABEL_GAP - 10);
  }

  /** Dark below light, or a rim below a colour: seen on every colour of the map. */
  #strokeTwice(stroke: () => void, width: number, color?: string): void {
    const pen = this.#pen;
    pen.strokeStyle = color === undefined ? HALO : this.#rim;
    pen.lineWidth = width + 2;
    stroke();
    pen.strokeStyle = color ?? INK;
    pen.lineWidth = width;
    stroke();
  }

  #textTwice(text: string, x: number, y: number): void {
    const pen = this.#pen;
    pen.strokeStyle = HALO;
    pen.lineWidth = 3;
    pen.strokeText(text, x, y);
    pen.fillStyle = INK;
    pen.fillText(text, x, y);
  }
}
