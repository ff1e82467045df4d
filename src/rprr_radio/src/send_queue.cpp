// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio/send_queue.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "rprr_radio/frame_chunk.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {
namespace {

// Memory stays bounded whatever receipts say.
constexpr std::size_t kStampsHeld = 64;   // frames that a receipt may name; a station holds a few
constexpr std::size_t kRobotsHeld = 32;   // robots whose frames this robot refers to
constexpr std::size_t kFramesKept = 2;    // whole frames that can be sent again
constexpr std::size_t kAwaitedKept = 16;  // references whose receipt is awaited

constexpr std::size_t kLeastChunk = 1380;  // [bytes] with its headers it fills one Ethernet frame
constexpr std::size_t kMostChunk = 8192;   // [bytes] at 200 kbit/s others wait a third of a second
// Weight of the newest sample. After five samples a change of the radio counts for five sixths.
constexpr double kSmoothing = 0.3;

constexpr double kQuick = 0.1;  // [s] a receipt that is quicker comes over a radio with much room
constexpr Duration kLostWhenQuick = from_seconds(2.0);
constexpr Duration kLostInSilence = from_seconds(8.0);
// Receipts may take so many times as long as usual before a frame counts as lost.
constexpr double kPatience = 2.5;
constexpr Duration kLongestPatience = from_seconds(20.0);
constexpr Duration kForgotten = from_seconds(60.0);  // a receipt that comes later tells nothing
// Bytes of the serialised message around its data, with TCPROS's length.
constexpr std::size_t kAround = encoded_message_bytes(0, 0) + 4;

void smooth(double sample, double& value) {
  value = value > 0.0 ? value + kSmoothing * (sample - value) : sample;
}

bool contains(const std::vector<Stamp>& stamps, Stamp stamp) {
  return std::find(stamps.begin(), stamps.end(), stamp) != stamps.end();
}

}  // namespace

SendQueue::SendQueue(SendQueueOptions options)
    : options_(std::move(options)), rate_(limited() ? options_.bandwidth : 1.0), next_number_(1) {
  options_.waiting = std::max<std::size_t>(options_.waiting, 1);
  held_[options_.robot];
}

void SendQueue::set_rate(double bandwidth, double frame_rate) {
  options_.frame_rate = frame_rate;
  if (bandwidth == options_.bandwidth) return;
  // Chunks of another size would not fit to those that are sent.
  for (Message& message : outgoing_) {
    message.next = 0;
    message.number = next_number_++;
  }
  options_.bandwidth = bandwidth;
  rate_ = RateLimit(limited() ? bandwidth : 1.0);
}

std::vector<QueuedFrame> SendQueue::offer(QueuedFrame frame, SteadyTime now) {
  std::vector<QueuedFrame> dropped;
  const bool newest_only = is_narrow() || receipts_ceased(now);
  for (auto entry = queue_.begin(); entry != queue_.end();) {
    const bool gives_way =
        newest_only ? entry->frame.sparse == frame.sparse : queue_.size() >= options_.waiting;
    if (gives_way) dropped.push_back(std::move(entry->frame));
    entry = gives_way ? queue_.erase(entry) : std::next(entry);
  }
  if (frame.sparse) {
    if (held_.size() < kRobotsHeld) held_[frame.reference];
    if (!is_held(frame.reference, frame.reference_stamp)) {
      awaited_.push_back({frame.reference_stamp, now});
    }
    if (awaited_.size() > kAwaitedKept) awaited_.pop_front();
  }
  queue_.push_back({std::move(frame), now});
  return dropped;
}

void SendQueue::spent(std::size_t bytes, SteadyTime now) {
  if (limited()) rate_.spend(bytes, now);
  control_ += bytes;
  // Forgets slowly, so that one long message does not hold the radio back for good.
  longest_control_ = std::max(bytes, longest_control_ - longest_control_ / 16);
}

void SendQueue::receipt(const std::string& robot, const std::vector<Stamp>& held,
                        const std::vector<Stamp>& repeat_stamps, Stamp last, SteadyTime now) {
  const auto known = held_.find(robot);
  last_receipt_ = now;
  if (known == held_.end()) return;
  const std::size_t count = std::min(held.size(), kStampsHeld);
  known->second.assign(held.end() - static_cast<std::ptrdiff_t>(count), held.end());
  if (robot != options_.robot) return learn_wait(known->second, now);
  if (options_.receipt_timeout > 0) acknowledge(last, known->second, now);
  for (std::size_t i = 0; i < std::min(repeat_stamps.size(), kFramesKept); ++i) {
    repeat(repeat_stamps[i], now);
  }
}

// TCPROS keeps the order of messages, so what came before the last one is there or lost.
void SendQueue::acknowledge(Stamp last, const std::vector<Stamp>& held, SteadyTime now) {
  const auto newest = std::find_if(in_flight_.rbegin(), in_flight_.rend(), [&](const Sent& sent) {
    return sent.stamp == last || (sent.whole && contains(held, sent.stamp));
  });
  if (newest == in_flight_.rend()) return;
  // The wait for one that was lost tells nothing of the radio.
  const auto last_sent = std::prev(newest.base());
  const Duration lost = lost_after();
  const auto first = std::find_if(in_flight_.begin(), last_sent,
                                  [&](const Sent& sent) { return now - sent.at <= lost; });
  learn(*newest, now);
  std::size_t bytes = 0;
  for (auto sent = first; sent != newest.base(); ++sent) bytes += sent->bytes;
  // The radio was busy with those before them until they were acknowledged.
  const SteadyTime since = std::max(first->at, acknowledged_at_);
  smooth(static_cast<double>(bytes) / std::max(to_seconds(now - since), 1e-3), delivery_rate_);
  acknowledged_at_ = now;
  in_flight_.erase(in_flight_.begin(), newest.base());
}

void SendQueue::learn(const Sent& sent, SteadyTime now) {
  const double seconds = std::max(to_seconds(now - sent.at), 1e-3);
  smooth(seconds, receipt_seconds_);
  if (sent.whole) smooth(std::max(to_seconds(now - sent.begun), 1e-3), whole_seconds_);
}

// How long receipts of references take, also of those that came too late.
void SendQueue::learn_wait(const std::vector<Stamp>& held, SteadyTime now) {
  for (auto reference = awaited_.begin(); reference != awaited_.end();) {
    const bool came = contains(held, reference->stamp);
    if (came) smooth(std::max(to_seconds(now - reference->since), 1e-3), reference_seconds_);
    const bool gone = came || now - reference->since > kForgotten;
    reference = gone ? awaited_.erase(reference) : std::next(reference);
  }
}

Duration SendQueue::reference_patience() const {
  return std::clamp(from_seconds(kPatience * reference_seconds_), options_.receipt_timeout,
                    std::max(kLongestPatience, options_.receipt_timeout));
}

Duration SendQueue::lost_after() const {
  const bool quick = receipt_seconds_ > 0.0 && receipt_seconds_ < kQuick;
  const Duration least =
      quick ? std::min(options_.lost_after, kLostWhenQuick) : options_.lost_after;
  return std::clamp(from_seconds(kPatience * receipt_seconds_), least,
                    std::max(kLongestPatience, least));
}

// Also while a station that did send receipts is silent: the radio may be down, and what is handed
// over then comes out late and all at once.
bool SendQueue::window_is_full(SteadyTime now) const {
  if (options_.in_flight == 0 || options_.receipt_timeout == 0 || !last_receipt_) return false;
  const Duration lost = hears_receipts(now) ? lost_after() : std::max(lost_after(), kLostInSilence);
  const auto under_way = std::count_if(in_flight_.begin(), in_flight_.end(),
                                       [&](const Sent& sent) { return now - sent.at <= lost; });
  const std::size_t window =
      is_narrow() || !(delivery_rate_ > 0.0) || !hears_receipts(now) ? 1 : options_.in_flight;
  return static_cast<std::size_t>(under_way) >= window;
}

void SendQueue::repeat(Stamp stamp, SteadyTime now) {
  const auto kept = std::find_if(kept_.begin(), kept_.end(),
                                 [stamp](const Kept& k) { return k.message.stamp == stamp; });
  if (kept == kept_.end()) return;
  if (kept->repeated && now - *kept->repeated < options_.repeat_period) return;
  const bool under_way =
      std::any_of(outgoing_.begin(), outgoing_.end(),
                  [stamp](const Message& message) { return message.stamp == stamp; });
  if (under_way) return;
  kept->repeated = now;
  outgoing_.push_back(kept->message);
  outgoing_.back().number = next_number_++;
  outgoing_.back().repeated = true;
  ++repeated_;
}

bool SendQueue::hears_receipts(SteadyTime now) const {
  return options_.receipt_timeout > 0 && last_receipt_ &&
         now - *last_receipt_ < options_.receipts_silence;
}

bool SendQueue::is_held(const std::string& robot, Stamp stamp) const {
  const auto known = held_.find(robot);
  return known != held_.end() && contains(known->second, stamp);
}

bool SendQueue::may_go(const Entry& entry, SteadyTime now) const {
  const QueuedFrame& frame = entry.frame;
  return !frame.sparse || !hears_receipts(now) || is_held(frame.reference, frame.reference_stamp) ||
         now - entry.offered >= reference_patience();
}

std::optional<EncodeOrder> SendQueue::next_to_encode(SteadyTime now) {
  if (encoding_ || (limited() && !outgoing_.empty()) || window_is_full(now)) return {};
  const auto eligible = [&](const Entry& entry) { return may_go(entry, now); };
  auto next = std::find_if(queue_.begin(), queue_.end(), eligible);
  if (next == queue_.end()) return {};
  // Neither kind keeps the other from the radio.
  const auto other = std::find_if(std::next(next), queue_.end(), eligible);
  if (is_narrow() && other != queue_.end() && next->frame.sparse == last_was_sparse_) next = other;
  EncodeOrder order;
  order.as_whole = next->frame.sparse && hears_receipts(now) &&
                   !is_held(next->frame.reference, next->frame.reference_stamp);
  order.frame = std::move(next->frame);
  order.limit = frame_limit();
  queue_.erase(next);
  last_was_sparse_ = order.frame.sparse;
  encoding_ = true;
  return order;
}

// What the wished frame rate leaves to a frame, of the budget less the exchange's messages.
std::size_t SendQueue::frame_limit() {
  control_per_frame_ += kSmoothing * (static_cast<double>(control_) - control_per_frame_);
  control_ = 0;
  const double rate = limited() ? rate_.steady_rate() : is_narrow() ? delivery_rate_ : 0.0;
  if (!(options_.frame_rate > 0.0) || !(rate > 0.0)) return 0;
  const double bytes = rate / options_.frame_rate;
  const double chunks = limited() ? bytes / static_cast<double>(chunk_size()) + 1.0 : 1.0;
  const double around = chunks * static_cast<double>(kAround + kChunkBytes);
  return static_cast<std::size_t>(std::max(1.0, bytes - control_per_frame_ - around));
}

std::size_t SendQueue::chunk_size() const {
  // Half a burst: so much may go at once, and a short message waits no longer than that.
  return std::clamp(static_cast<std::size_t>(0.1 * options_.bandwidth), kLeastChunk, kMostChunk);
}

void SendQueue::encoded(const EncodeOrder& order, Bytes data, SteadyTime now) {
  encoding_ = false;
  const QueuedFrame& frame = order.frame;
  Message message;
  message.stamp = frame.stamp;
  message.frame_id = frame.frame_id;
  message.exchange = frame.exchange;
  message.data = std::move(data);
  message.number = next_number_++;
  message.begun = now;
  const auto bytes = static_cast<double>(message.data.size());
  if (order.limit == 0 || bytes < 0.9 * static_cast<double>(order.limit)) {
    smooth(bytes, usual_bytes_);
  }
  message.whole = !frame.sparse || order.as_whole;
  if (message.whole) {
    kept_.push_back({message, {}});
    if (kept_.size() > kFramesKept) kept_.pop_front();
  }
  outgoing_.push_back(std::move(message));
}

std::optional<SendOrder> SendQueue::next_to_send(SteadyTime now) {
  if (outgoing_.empty()) return {};
  Message& message = outgoing_.front();
  SendOrder order{message.stamp, message.frame_id, message.exchange, {}};
  const std::size_t most = chunk_size();
  const std::size_t count = (message.data.size() + most - 1) / most;
  if (!limited() || count > kMostChunks) {
    order.data = std::move(message.data);
    sent_all(order.data.size(), now);
    return order;
  }
  if (message.next > 0) order.frame_id.clear();
  const ByteView rest = ByteView(message.data).from(message.next * most);
  const ByteView piece = rest.first(std::min(rest.size, most));
  const std::size_t frame_bytes = message.data.size();
  const std::size_t bytes =
      kAround + order.frame_id.size() + piece.size + (count > 1 ? kChunkBytes : 0);
  if (now < rate_.room_at(bytes, now)) return {};
  rate_.spend(bytes, now);
  if (count == 1) {
    order.data = std::move(message.data);
  } else {
    order.data = serialise(FrameChunk{message.number, static_cast<std::uint16_t>(message.next),
                                      static_cast<std::uint16_t>(count), piece});
  }
  if (++message.next == count) sent_all(frame_bytes, now);
  return order;
}

void SendQueue::sent_all(std::size_t bytes, SteadyTime now) {
  const Message& message = outgoing_.front();
  if (!message.repeated) {
    in_flight_.push_back({message.stamp, message.begun, now, bytes, message.whole});
    if (!last_receipt_ && message.whole) {
      smooth(std::max(to_seconds(now - message.begun), 1e-3), whole_seconds_);
    }
    if (in_flight_.size() > kStampsHeld) in_flight_.pop_front();
    if (message.whole) own_sent_.push_back(message.stamp);
    if (own_sent_.size() > kFramesKept) own_sent_.pop_front();
  }
  outgoing_.pop_front();
}

std::size_t SendQueue::bytes_left() const {
  std::size_t bytes = 0;
  for (const Message& message : outgoing_) {
    bytes += message.data.size() - std::min(message.data.size(), message.next * chunk_size());
  }
  return bytes;
}

double SendQueue::backlog(SteadyTime now) {
  if (!limited()) return 0.0;
  const double debt = to_seconds(rate_.room_at(0, now) - now);
  return debt + static_cast<double>(bytes_left()) / rate_.steady_rate();
}

LinkState SendQueue::link_state(SteadyTime now) {
  LinkState link;
  link.frame_seconds = whole_seconds_;
  if (is_narrow()) link.has_room = queue_.empty() && outgoing_.empty() && !encoding_;
  if (limited() && now < rate_.room_at(longest_control_, now)) link.has_room = false;
  if (window_is_full(now)) link.has_room = false;
  if (hears_receipts(now)) {
    link.references = held_.at(options_.robot);
  } else {
    link.references.assign(own_sent_.begin(), own_sent_.end());
  }
  return link;
}

}  // namespace rprr
