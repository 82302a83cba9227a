// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { SLOTS, type Trail } from "../../live/contact_slots";
import type { ArrayLive } from "../../live/live_data";
import { type Region, regionName } from "../../live/region_force";
import { type Contact, ContactPhase } from "../../messages/contacts";
import type { Area } from "../../render/heat_maps";
import type { ArrayDescription } from "../../suit";
import { cssColor } from "../../theme";
import { type LabelBox, LabelRoom } from "../label_room";
import { AXIS_LEFT, boundsOf, boxOf, cellOf, pointOn } from "./geometry";

const TURN = 2 * Math.PI;
const CENTRE_PIXELS = 7;
const LABEL_HEIGHT = 18;
/** Size of a contact's middle, which no label may hide. */
const MIDDLE_PIXELS = 14;
const HALO = "rgb(0 0 0 / 70%)";
const INK = "#ffffff";
const FONT = '600 12px "Inter", "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", Arial, sans-serif';

/** The marks over the maps; undefined ones are not drawn. */
export interface Marks {
  /** The map of forces or pressures, which alone has contacts and their centre. */
  readonly load: Area;
  readonly contacts: ArrayLive | undefined;
  /** [N] by the ids of contacts, as the table shows them; others have their own. */
  readonly forces: ReadonlyMap<number, number>;
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
  #plate = "";
  #plateText = "";

  constructor(canvas: HTMLCanvasElement) {
    this.canvas = canvas;
    this.#pen = canvas.getContext("2d")!;
  }

  readColors(): void {
    this.#seriesColors = Array.from({ length: SLOTS }, (_, index) => cssColor(`--series-${index + 1}`));
    this.#plate = cssColor("--surface");
    this.#plateText = cssColor("--text");
  }

  resize(width: number, height: number, pixelRatio: number): void {
    this.canvas.width = Math.round(width * pixelRatio);
    this.canvas.height = Math.round(height * pixelRatio);
    this.#pen.setTransform(pixelRatio, 0, 0, pixelRatio, 0, 0);
  }

  draw(
    areas: readonly Area[],
    array: ArrayDescription,
    { load, contacts, forces, centre, region, cursor, pins }: Marks,
  ): void {
    this.#pen.save();
    this.#pen.resetTransform();
    this.#pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    this.#pen.restore();
    const room = new LabelRoom(load.width, load.height);
    for (const area of areas) {
      if (area.width === 0) continue;
      pins.forEach((taxel, index) => this.#drawPin(area, array, taxel, index + 1));
      if (cursor >= 0) this.#drawCursor(area, array, cursor);
      if (region?.array !== array.name) continue;
      const label = this.#drawRegion(area, array, region);
      if (area === load) room.take(label);
    }
    if (load.width === 0) return;
    if (contacts !== undefined) this.#drawContacts(load, array, contacts, forces, room);
    if (centre !== undefined && array.places === undefined) this.#drawCentre(centre, scaleOf(load, array));
  }

  /** Returns where its name is on the map. */
  #drawRegion(area: Area, array: ArrayDescription, region: Region): LabelBox {
    const { left, top, width, height } = boxOf(area, array, region.rows, region.cols);
    const pen = this.#pen;
    pen.setLineDash([7, 4]);
    this.#strokeTwice(() => pen.strokeRect(left, top, width, height), 2);
    pen.setLineDash([]);
    pen.font = FONT;
    pen.textAlign = "left";
    pen.textBaseline = "bottom";
    const bottom = top + height - 3;
    this.#textTwice(regionName(region), left + 4, bottom);
    const textWidth = pen.measureText(regionName(region)).width;
    return {
      x: left + 4 + 0.5 * textWidth - area.left,
      y: bottom - 0.5 * LABEL_HEIGHT - area.top,
      width: textWidth,
      height: LABEL_HEIGHT,
    };
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

  #drawContacts(
    area: Area,
    array: ArrayDescription,
    live: ArrayLive,
    forces: ReadonlyMap<number, number>,
    room: LabelRoom,
  ): void {
    const { originX, originY, pixelsX, pixelsY } = scaleOf(area, array);
    const pen = this.#pen;
    pen.save();
    pen.beginPath();
    pen.rect(area.left - AXIS_LEFT, area.top, area.width + 2 * AXIS_LEFT, area.height);
    pen.clip();
    const touching = live.contacts.contacts
      .slice(0, live.contacts.count)
      .filter(({ phase }) => phase !== ContactPhase.release);
    for (const contact of touching) {
      if (array.places === undefined)
        this.#drawTrail(live, live.slots.indexOf(contact.id), originX, originY, pixelsX, pixelsY);
      const [x, y] = pointOn(area, array, contact.x, contact.y);
      this.#drawOutline(contact, x, y, pixelsX, pixelsY);
      const middle = { x: x - area.left, y: y - area.top };
      room.take({ ...middle, width: MIDDLE_PIXELS, height: MIDDLE_PIXELS });
      room.avoid({ ...middle, radius: Math.sqrt(contact.areaM2 / Math.PI) * Math.max(pixelsX, pixelsY) });
    }
    for (const contact of touching) {
      const reach = 0.75 * Math.sqrt(contact.areaM2 / Math.PI);
      const [middleX, middleY] = pointOn(area, array, contact.x, contact.y);
      const [x, y] = [middleX + reach * pixelsX + 4, middleY - reach * pixelsY - 22];
      this.#drawLabel(
        contact,
        forces.get(contact.id) ?? contact.forceN,
        live.slots.indexOf(contact.id),
        x,
        y,
        area,
        room,
      );
    }
    pen.restore();
  }

  #drawTrail(live: ArrayLive, slot: number, originX: number, originY: number, pixelsX: number, pixelsY: number): void {
    const trail = live.slots.slots[slot]?.trail;
    if (trail === undefined || trail.length < 2) return;
    const pen = this.#pen;
    for (let point = 1; point < trail.length; ++point) {
      pen.globalAlpha = (0.7 * point) / trail.length;
      pen.beginPath();
      pen.moveTo(originX + trail.x(point - 1) * pixelsX, originY + trail.y(point - 1) * pixelsY);
      pen.lineTo(originX + trail.x(point) * pixelsX, originY + trail.y(point) * pixelsY);
      this.#strokeTwice(() => pen.stroke(), 1.25);
    }
    pen.globalAlpha = 1;
  }

  /** An ellipse of the area of the contact, in its proportions; inside, where it is with 95 %: two sigmas. */
  #drawOutline(contact: Contact, x: number, y: number, pixelsX: number, pixelsY: number): void {
    const pen = this.#pen;
    const slenderness = contact.minorAxisM > 0 ? Math.min(4, contact.majorAxisM / contact.minorAxisM) : 1;
    const major = Math.sqrt((contact.areaM2 / Math.PI) * slenderness) * pixelsX;
    const minor = Math.sqrt(contact.areaM2 / Math.PI / slenderness) * pixelsY;
    const ellipse = (radiusX: number, radiusY: number, angle: number): void => {
      pen.beginPath();
      pen.ellipse(x, y, Math.max(1, radiusX), Math.max(1, radiusY), angle, 0, TURN);
      pen.stroke();
    };
    this.#strokeTwice(() => ellipse(major, minor, contact.angleRad), 1.5);
    this.#strokeTwice(() => ellipse(2 * contact.sigmaX * pixelsX, 2 * contact.sigmaY * pixelsY, 0), 1.5);
  }

  /** With its corner at x and y or where there is room near it; without any, its line in the table has to do. */
  #drawLabel(contact: Contact, forceN: number, slot: number, x: number, y: number, area: Area, room: LabelRoom): void {
    const pen = this.#pen;
    const text = `#${contact.id}  ${forceN.toFixed(forceN < 10 ? 2 : 1)} N`;
    pen.font = FONT;
    const width = pen.measureText(text).width + 16;
    const place = room.place({
      x: x - area.left + 0.5 * width,
      y: y - area.top + 0.5 * LABEL_HEIGHT,
      width,
      height: LABEL_HEIGHT,
    });
    if (place === undefined) return;
    const left = area.left + place.x - 0.5 * width;
    const top = area.top + place.y - 0.5 * LABEL_HEIGHT;
    pen.fillStyle = this.#plate;
    pen.globalAlpha = 0.92;
    pen.fillRect(left, top, width, LABEL_HEIGHT);
    pen.globalAlpha = 1;
    pen.fillStyle = this.#seriesColors[slot] ?? this.#plateText;
    pen.fillRect(left, top, 4, LABEL_HEIGHT);
    pen.fillStyle = this.#plateText;
    pen.textAlign = "left";
    pen.textBaseline = "middle";
    pen.fillText(text, left + 9, top + 9.5);
  }

  /** Dark below light: seen on every colour of the map. */
  #strokeTwice(stroke: () => void, width: number): void {
    const pen = this.#pen;
    pen.strokeStyle = HALO;
    pen.lineWidth = width + 2;
    stroke();
    pen.strokeStyle = INK;
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
