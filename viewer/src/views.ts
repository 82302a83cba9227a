// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { createCalibrationView } from "./calibration/calibration_view";
import type { ViewFactory } from "./view";
import { createArrayView } from "./views/array/array_view";
import { createHealthView } from "./views/health/health_view";
import { createRecognitionView } from "./views/recognition/recognition_view";
import { createSuitView } from "./views/suit/suit_view";
import { createTimeView } from "./views/time/time_view";

/** The views in the order of their tabs. */
export const VIEWS: readonly ViewFactory[] = [
  createArrayView,
  createTimeView,
  createSuitView,
  createRecognitionView,
  createHealthView,
  createCalibrationView,
];
