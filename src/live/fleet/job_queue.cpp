// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/job_queue.hpp"

#include <algorithm>
#include <charconv>
#include <span>
#include <utility>

#include "live/fleet/broker.hpp"
#include "live/fleet/json_values.hpp"
#include "live/fleet/streams.hpp"

namespace dermis::live::fleet {
namespace {

constexpr const char* kJobs = "dermis-jobs";  // a stream and its consumer
constexpr const char* kJobSubject = "dermis-jobs.job";
constexpr const char* kOutcomes = "dermis-outcomes";
constexpr const char* kDone = "dermis-outcomes.done.";  // and the number of the job
constexpr const char* kGivenUp = "dermis-outcomes.given-up.";
constexpr std::chrono::nanoseconds kTakeWait = std::chrono::seconds(1);
constexpr std::size_t kMostOfLease = 4096;

/// The tries and the number of a job, in its lease "$JS.ACK.<stream>.<consumer>.<tries>.<number>...".
struct LeaseParts {
  std::uint64_t tries = 1;
  std::string number;
};

LeaseParts parts_of(const std::string& lease) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= lease.size() && lease.size() < kMostOfLease) {
    const std::size_t end = std::min(lease.find('.', begin), lease.size());
    parts.push_back(lease.substr(begin, end - begin));
    begin = end + 1;
  }
  LeaseParts found;
  if (parts.size() < 6) return found;
  std::from_chars(parts[4].data(), parts[4].data() + parts[4].size(), found.tries);
  found.number = parts[5];
  return found;
}

std::string to_json(const JobOutcome& outcome) {
  return Json({{"name", outcome.name},
               {"worker", outcome.worker},
               {"seconds", outcome.seconds},
               {"error", outcome.error}})
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// In one line each: the texts are of others.
JobOutcome outcome_of(const std::vector<std::uint8_t>& bytes) {
  const Json json = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
  const auto line_at = [&](const char* key) { return bad_input(text_at(json, key)).message; };
  return {line_at("name"), line_at("worker"), 0.0, line_at("error")};
}

/// How many subjects of the stream begin so; each has one message.
Result<std::uint64_t> subjects_of(Broker& broker, const std::string& stream, const std::string& begin) {
  const std::string wanted = Json({{"subjects_filter", begin + ">"}}).dump();
  const Result<std::string> answer = broker.ask("$JS.API.STREAM.INFO." + stream, wanted);
  if (!answer) return answer.error();
  return std::uint64_t{object_at(object_at(Json::parse(*answer, nullptr, false), "state"), "subjects").size()};
}

}  // namespace

JobQueue::JobQueue(std::unique_ptr<Broker> broker) : broker_(std::move(broker)) {}

JobQueue::~JobQueue() = default;

Result<std::unique_ptr<JobQueue>> JobQueue::connect(const BrokerAddress& address) {
  Result<std::unique_ptr<Broker>> broker = connect_broker(address);
  if (!broker) return broker.error();
  if (const Status made = make_work_queue(**broker, kJobs, kJobSubject, JobQueue::kLeases); !made) return made.error();
  if (const Status made = make_log(**broker, kOutcomes, std::string(kOutcomes) + ".>"); !made) return made.error();
  return std::unique_ptr<JobQueue>(new JobQueue(*std::move(broker)));
}

Status JobQueue::submit(const Job& job) {
  if (Status good = check_job(job); !good) return good;
  const std::string text = job_to_json(job);
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const Result<std::uint64_t> stored = broker_->store(kJobSubject, "", bytes);
  return stored ? Status(Done{}) : Status(stored.error());
}

Result<std::optional<TakenJob>> JobQueue::take() {
  const std::string wanted = Json({{"batch", 1}, {"expires", kTakeWait.count()}}).dump();
  const Result<std::optional<Delivery>> delivery =
      broker_->take(std::string("$JS.API.CONSUMER.MSG.NEXT.") + kJobs + "." + kJobs, wanted);
  if (!delivery) return delivery.error();
  if (!*delivery) return std::optional<TakenJob>();
  const LeaseParts lease = parts_of((*delivery)->lease);
  if (lease.number.empty()) return failed("the server's lease of a job cannot be read");
  TakenJob taken;
  taken.id = lease.number;
  taken.tries = lease.tries;
  taken.lease = (*delivery)->lease;
  const Result<Job> job = job_from_json((*delivery)->text);
  if (job) taken.job = *job;
  if (job && taken.tries <= kMostTries) return std::optional(std::move(taken));
  const std::string why = job ? "its worker ended " + std::to_string(kMostTries) + " times" : job.error().message;
  if (const Status given_up = give_up(taken, why); !given_up) return given_up.error();
  return std::optional<TakenJob>();
}

Status JobQueue::extend(const TakenJob& job) {
  return broker_->send(job.lease, "+WPI");
}

Status JobQueue::give_back(const TakenJob& job) {
  return broker_->send(job.lease, "-NAK");
}

Status JobQueue::give_up(const TakenJob& job, const std::string& why) {
  const Result<std::optional<StoredMessage>> done = broker_->last(kOutcomes, kDone + job.id);
  if (!done) return done.error();
  if (!*done) {  // nor by another worker, which had it before or after this one
    if (Status stored = store_outcome(kGivenUp + job.id, {job.job.name, "", 0.0, why}); !stored) return stored;
  }
  const Result<std::string> away = broker_->ask(job.lease, "+TERM");
  return away ? Status(Done{}) : Status(away.error());
}

Status JobQueue::finish(const TakenJob& job, const JobOutcome& outcome) {
  if (!outcome.error.empty()) {
    const bool is_last = outcome.is_final || job.tries >= kMostTries;
    return is_last ? give_up(job, outcome.error) : give_back(job);
  }
  if (Status stored = store_outcome(kDone + job.id, outcome); !stored) return stored;
  const Result<std::string> away = broker_->ask(job.lease, "+ACK");
  return away ? Status(Done{}) : Status(away.error());
}

Status JobQueue::store_outcome(const std::string& subject, const JobOutcome& outcome) {
  const std::string text = to_json(outcome);
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const Result<std::uint64_t> stored = broker_->store(subject, "", bytes);
  return stored ? Status(Done{}) : Status(stored.error());
}

Result<JobCounts> JobQueue::counts() {
  JobCounts counts;
  const Result<std::string> answer = broker_->ask(std::string("$JS.API.CONSUMER.INFO.") + kJobs + "." + kJobs, "");
  if (!answer) return answer.error();
  const Json consumer = Json::parse(*answer, nullptr, false);
  if (!consumer.is_object()) return failed("the state of the jobs cannot be read");
  counts.waiting = number_at(consumer, "num_pending");
  counts.taken = number_at(consumer, "num_ack_pending");
  const Result<std::uint64_t> done = subjects_of(*broker_, kOutcomes, kDone);
  if (!done) return done.error();
  const Result<std::uint64_t> given_up = subjects_of(*broker_, kOutcomes, kGivenUp);
  if (!given_up) return given_up.error();
  counts.done = *done;
  counts.given_up = *given_up;
  return counts;
}

Result<std::vector<JobOutcome>> JobQueue::given_up() {
  std::vector<JobOutcome> outcomes;
  for (std::uint64_t next = 1;;) {
    const Result<std::optional<StoredMessage>> message = broker_->next(kOutcomes, std::string(kGivenUp) + "*", next);
    if (!message) return message.error();
    if (!*message) return outcomes;
    outcomes.push_back(outcome_of((*message)->bytes));
    next = (*message)->sequence + 1;
  }
}

}  // namespace dermis::live::fleet
