// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { CdrReader } from "./cdr_reader";

export const ContactPhase = { onset: 0, held: 1, release: 2 } as const;

/** dermis_msgs/Contact.msg without `velocity`. */
export class Contact {
  id = 0;
  phase = 0;
  onsetS = 0;
  x = 0;
  y = 0;
  sigmaX = 0;
  sigmaY = 0;
  velocityX = 0;
  velocityY = 0;
  forceN = 0;
  sigmaForceN = 0;
  areaM2 = 0;
  peakPressurePa = 0;
  meanPressurePa = 0;
  majorAxisM = 0;
  minorAxisM = 0;
  angleRad = 0;
  taxels = 0;
  readonly position = new Float64Array(3);
  readonly normal = new Float64Array(3);
}

/** dermis_msgs/Contacts.msg: of one frame of one array. `contacts` is longer than `count` where there were more before. */
export class ContactsFrame {
  stampS = 0;
  totalForceN = 0;
  sigmaTotalN = 0;
  hasCentreOfPressure = false;
  readonly centreOfPressure = new Float64Array(3);
  count = 0;
  readonly contacts: Contact[] = [];
  /** Force on the whole array, and its standard deviation. */
  sumN = NaN;
  sigmaSumN = NaN;
}

const MOST_CONTACTS = 4096;
const reader = new CdrReader();

/** The array of the message: its index in `names`, -1 where it is not there; then `readContacts` may be called. */
export function readContactsArray(message: DataView, names: readonly string[]): number {
  reader.begin(message).header();
  const mark = reader.position;
  for (let index = 0; index < names.length; ++index) {
    if (reader.rewind(mark).textIs(names[index]!)) return index;
  }
  return -1;
}

export function readContacts(message: DataView, frame: ContactsFrame): void {
  frame.stampS = reader.begin(message).header();
  reader.skipText();
  frame.totalForceN = reader.float64();
  frame.sigmaTotalN = reader.float64();
  frame.hasCentreOfPressure = reader.bool();
  readTriple(frame.centreOfPressure);
  const count = reader.uint32();
  if (count > MOST_CONTACTS) throw new RangeError(`${count} contacts`);
  while (frame.contacts.length < count) frame.contacts.push(new Contact());
  frame.count = count;
  for (let index = 0; index < count; ++index) readContact(frame.contacts[index]!);
  frame.sumN = reader.float64();
  frame.sigmaSumN = reader.float64();
}

function readTriple(target: Float64Array): void {
  target[0] = reader.float64();
  target[1] = reader.float64();
  target[2] = reader.float64();
}

function readContact(contact: Contact): void {
  contact.id = reader.uint32();
  contact.phase = reader.uint8();
  contact.onsetS = reader.time();
  contact.x = reader.float64();
  contact.y = reader.float64();
  contact.sigmaX = reader.float64();
  contact.sigmaY = reader.float64();
  contact.velocityX = reader.float64();
  contact.velocityY = reader.float64();
  contact.forceN = reader.float64();
  contact.sigmaForceN = reader.float64();
  contact.areaM2 = reader.float64();
  contact.peakPressurePa = reader.float64();
  contact.meanPressurePa = reader.float64();
  contact.majorAxisM = reader.float64();
  contact.minorAxisM = reader.float64();
  contact.angleRad = reader.float64();
  contact.taxels = reader.uint32();
  readTriple(contact.position);
  readTriple(contact.normal);
  reader.skip(3, 8);
}
