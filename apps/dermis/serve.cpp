// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>
#include <malloc.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "commands.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/recording.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/live/dds/publisher.hpp"
#include "dermis/live/fleet/frame_publisher.hpp"
#include "dermis/live/sources/array_folder.hpp"
#include "dermis/live/sources/source_name.hpp"
#include "dermis/out/serve/array_setup.hpp"
#include "dermis/out/serve/session.hpp"
#include "server_options.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"
#include "viewer/viewer_assets.hpp"

namespace dermis::app {
namespace {

struct ServeOptions {
  out::serve::SuitPlace place;
  out::serve::SessionOptions session;
  std::string token_file{};
  bool dds = false;
  std::optional<std::uint64_t> domain{};
  std::string publish{};
  std::string robot{};
  bool take_over = false;
};

Status check(const ServeOptions& options) {
  const out::serve::SuitPlace& place = options.place;
  if (place.suit.empty() && place.from.empty() && !place.model.empty()) {
    return bad_input("serve: give --from with its --model; without both the page asks for the device");
  }
  if (!place.suit.empty() && !place.model.empty()) return bad_input("--model: suit.toml names the models");
  if (!place.suit.empty() && !place.classes.empty()) return bad_input("--classes: suit.toml names the classes");
  const std::string& record = options.session.record;
  const Result<bytes::recordings::FrameFormat> format = bytes::recordings::frame_format(record);
  const bool is_recording = format && *format == bytes::recordings::FrameFormat::mcap;
  if (!record.empty() && !is_recording) return bad_input("--record: end it in .mcap");
  return options.session.server.validate();
}

Result<live::fleet::PublisherOptions> publisher_options(const ServeOptions& options) {
  const Result<live::fleet::BrokerAddress> broker = live::fleet::parse_broker_address(options.publish);
  if (!broker) return bad_input("--publish: " + broker.error().message);
  if (Status good = live::fleet::check_name("--robot", options.robot); !good) return good.error();
  return live::fleet::PublisherOptions{.broker = *broker, .robot = options.robot, .take_over = options.take_over};
}

/// A suit.toml tells of several arrays, the page of one.
Status check_one_array(const std::string& from) {
  const bytes::recordings::RecordingPlace place = bytes::recordings::recording_place(from);
  const auto recording = bytes::recordings::SuitRecordingReader::open(place.path);
  if (!place.array.empty() || !recording || (*recording)->arrays().size() == 1) return Done{};
  const Result<std::size_t> one = bytes::recordings::find_array((*recording)->arrays(), place.path, place.array);
  return bad_input(one.error().message + "; or play all of it with --suit suit.toml");
}

/// Whether somebody has to describe the array. Fails on a source that cannot be served.
Result<bool> is_of_unknown_array(const out::serve::SuitPlace& place) {
  if (!place.suit.empty() || !place.model.empty()) return false;
  if (place.from.empty()) return true;
  const Result<live::sources::SourceName> from = live::sources::SourceName::parse(place.from);
  if (!from) return from.error();
  if (Status can = out::serve::check_served(*from); !can) return can.error();
  if (from->kind == live::sources::SourceKind::recording) {
    if (Status one = check_one_array(place.from); !one) return one.error();
  }
  return !out::serve::describes_its_array(*from);
}

/// A user describes the array on the page; its array.toml is served from then on, at the same address.
Status set_up_array(ServeOptions& options) {
  const Result<std::unique_ptr<out::serve::ArraySetup>> setup = out::serve::ArraySetup::create(
      options.place.from, options.session, {.stop = &stop_flag(), .notice = print_notice});
  if (!setup) return setup.error();
  options.session.server.port = (*setup)->port();
  print_notice(fmt::format("describe the array at {} (Ctrl-C ends it)",
                           server_address(options.session.server, options.session.server.port)));
  out::serve::DescribedArray array = (*setup)->run(stop_flag());
  options.place.from = std::move(array.from);
  options.place.model = std::move(array.model);
  options.place.suit = std::move(array.suit);
  const std::string& file = options.place.suit.empty() ? options.place.model : options.place.suit;
  if (!file.empty()) print_notice((array.is_new ? "wrote " : "by ") + file);
  return Done{};
}

/// `--from mat`: the folder of an array has its newest model and its source.
Status open_folder(out::serve::SuitPlace& place) {
  if (!live::sources::is_array_folder(place.from)) return Done{};
  const Result<live::sources::ArrayFolder> folder = live::sources::read_array_folder(place.from);
  if (!folder) return folder.error();
  if (folder->from.empty()) {
    return bad_input(
        fmt::format("'{}': has no source.toml: say --from where it is, with --model {}", folder->path, folder->model));
  }
  place.from.clear();
  if (folder->is_suit()) {
    place.suit = folder->model;
    return Done{};
  }
  const Result<ArrayDescription> array = bytes::files::read_array(folder->path + "/array.toml");
  if (!array) return array.error();
  const Result<live::sources::SourceName> found = live::sources::find_source(
      *folder, array->order.sent({array->rows, array->cols}), {.stop = &stop_flag(), .notice = print_notice});
  if (!found) return found.error();
  place.from = found->text;
  if (place.model.empty()) place.model = folder->model;
  return live::sources::write_array_source(folder->path, *found);
}

/// Those of an array with a folder of its own lie in it.
void place_recordings(const out::serve::SuitPlace& place, out::serve::SessionOptions& session) {
  const std::filesystem::path folder =
      std::filesystem::path(place.suit.empty() ? place.model : place.suit).parent_path();
  if (!live::sources::is_array_folder(folder.string())) return;
  session.recordings = (folder / folder.filename()).string() + ".mcap";
}

Status serve_suit(ServeOptions& options) {
  ::mallopt(M_ARENA_MAX, 1);  // threads with heaps of their own keep twice the memory, and it grows for days
  if (Status opened = open_folder(options.place); !opened) return opened;
  if (Status found = find_token(options.token_file, options.session.server); !found) return found;
  if (Status possible = check(options); !possible) return possible;
  if (options.dds) {
    Result<live::dds::PublisherOptions> dds = live::dds::options_of_environment(options.domain);
    if (!dds) return dds.error();
    options.session.dds = *dds;
  }
  if (!options.publish.empty()) {
    Result<live::fleet::PublisherOptions> publish = publisher_options(options);
    if (!publish) return publish.error();
    options.session.publish = *std::move(publish);
  }
  const std::atomic<bool>& stop = stop_flag();
  const std::span<const out::websocket::Asset> page = viewer::assets();
  options.session.page.assign(page.begin(), page.end());
  options.session.server.notice = print_notice;
  const Result<bool> is_unknown = is_of_unknown_array(options.place);
  if (!is_unknown) return is_unknown.error();
  if (*is_unknown) {
    if (Status set_up = set_up_array(options); !set_up || stop) return set_up;
  }
  place_recordings(options.place, options.session);
  Result<out::serve::ServedSuit> suit = out::serve::open_suit(options.place, {.stop = &stop, .notice = print_notice});
  if (!suit) return suit.error();
  const std::size_t arrays = suit->arrays.size();
  const std::string what = arrays == 1 ? suit->arrays.front().name : fmt::format("{} arrays", arrays);
  const Result<std::unique_ptr<out::serve::Session>> session =
      out::serve::Session::create(*std::move(suit), options.session);
  if (!session) return session.error();
  print_notice(fmt::format("serving {} at {} (Ctrl-C ends it)", what,
                           server_address(options.session.server, (*session)->port())));
  if (options.session.dds) {
    print_notice(fmt::format("topics for ROS 2 are in domain {}, for {}", options.session.dds->domain,
                             options.session.dds->loopback_only ? "this machine" : "all of the network"));
  }
  return (*session)->run(stop);
}

}  // namespace

void add_serve(Command& command) {
  auto options = std::make_shared<ServeOptions>();
  command.option("--from", options->place.from,
                 "URI of a device or of the simulator, or a recording; without it the page asks where the array is");
  command.option("--model", options->place.model,
                 "Its model, or the array.toml of an array to be calibrated; without it recording or simulator tell, "
                 "or the page asks");
  command.option("--suit", options->place.suit, "suit.toml: several arrays with their sources and models");
  command.option("--classes", options->place.classes,
                 "Classes of 'dermis recognise learn', from newtons: name what touches the array");
  command.option("--threats", options->place.threats, "threats.toml: limits for the forces");
  command.option("--record", options->session.record, "Record from the beginning, .mcap");
  command.heading("Network");
  add_server_options(command, options->session.server, options->token_file);
  const Option dds = command.flag("--dds", options->dds, "Topics for ROS 2, too (docs/ros.md)");
  command.option("--domain", options->domain, "Their domain; else that of ROS_DOMAIN_ID, or 0").needs(dds);
  const Option publish =
      command.option("--publish", options->publish, "nats://HOST: keep all frames in a stream, too (docs/fleet.md)");
  command.option("--robot", options->robot, "The name of this robot in the fleet").needs(publish);
  command
      .flag("--take-over", options->take_over, "Take the name from a process that has it; that one publishes no more")
      .needs(publish);
  command.action([options] { return serve_suit(*options); });
}

}  // namespace dermis::app
