// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/contacts_csv.hpp"

#include <initializer_list>
#include <utility>

#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/millimetres.hpp"

namespace dermis::bytes::files {
namespace {

constexpr const char* kHeader =
    "time_s,id,phase,x_mm,y_mm,sigma_x_mm,sigma_y_mm,velocity_x_mm_per_s,velocity_y_mm_per_s,force_n,sigma_force_n,"
    "area_mm2,peak_pressure_kpa,mean_pressure_kpa,major_axis_mm,minor_axis_mm,angle_rad,taxels\n";
constexpr double kPascalsPerKilopascal = 1e3;

const char* name_of(ContactPhase phase) {
  switch (phase) {
    case ContactPhase::onset: return "onset";
    case ContactPhase::held: return "held";
    case ContactPhase::release: break;
  }
  return "release";
}

void append_cells(std::string& line, std::initializer_list<double> values) {
  for (const double value : values) {
    line += ',';
    append_number(line, static_cast<float>(value));
  }
}

void append(std::string& line, const Contact& contact) {
  constexpr double kMm = kMillimetresPerMetre;
  line += ',' + std::to_string(contact.id) + ',' + name_of(contact.phase);
  append_cells(
      line, {kMm * contact.position.x, kMm * contact.position.y, kMm * contact.sigma_position_m.x,
             kMm * contact.sigma_position_m.y, kMm * contact.velocity.x, kMm * contact.velocity.y, contact.force_n,
             contact.sigma_force_n, kMm * kMm * contact.area_m2, contact.peak_pressure_pa / kPascalsPerKilopascal,
             contact.mean_pressure_pa / kPascalsPerKilopascal, kMm * contact.major_axis_m, kMm * contact.minor_axis_m,
             contact.angle_rad});
  line += ',' + std::to_string(contact.taxels) + '\n';
}

}  // namespace

ContactsCsvWriter::ContactsCsvWriter(AtomicFile file) : file_(std::move(file)) {}

Result<ContactsCsvWriter> ContactsCsvWriter::create(const std::string& path) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  file->write(kHeader);
  return ContactsCsvWriter(*std::move(file));
}

Status ContactsCsvWriter::write(const ContactReport& report) {
  lines_.clear();
  for (const Contact& contact : report.contacts) {
    append_seconds(lines_, report.time);
    append(lines_, contact);
  }
  file_.write(lines_);
  return file_.status();
}

Status ContactsCsvWriter::commit() {
  return file_.commit();
}

}  // namespace dermis::bytes::files
