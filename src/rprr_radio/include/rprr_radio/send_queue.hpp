// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rprr_geometry/option_table.hpp"
#include "rprr_geometry/stamp.hpp"
#include "rprr_geometry/steady_time.hpp"
#include "rprr_radio/link_state.hpp"
#include "rprr_radio/rate_limit.hpp"
#include "rprr_wire/bytes.hpp"

namespace rprr {

/// Below, a chunk would be longer than what may go at once.
constexpr double kLeastBandwidth = 8000.0;

struct SendQueueOptions {
  std::string robot;          ///< this robot's name
  double bandwidth = 0.0;     ///< of all messages of this robot [bytes/s]; 0: no limit, else at
                              ///< least kLeastBandwidth
  double frame_rate = 1.0;    ///< for which colours are coarsened, if need be [frames/s]
  std::size_t waiting = 5;    ///< most frames that wait to be encoded
  std::size_t in_flight = 3;  ///< most frames without receipt; 0: any number
  /// A sparse frame waits so long for the receipt of its reference, or longer where receipts were
  /// seen to take longer, then goes out whole. 0: the station's receipts are not waited for.
  Duration receipt_timeout = from_seconds(2.0);
  /// Without any receipt for so long, the station is taken to send none.
  Duration receipts_silence = from_seconds(3.0);
  /// A frame without receipt for so long is not on its way any more. It may take longer where
  /// receipts were seen to take longer; two seconds are enough where they come at once.
  Duration lost_after = from_seconds(4.0);
  Duration repeat_period = from_seconds(1.0);  ///< least time between two repeats of a frame
};

/// Live: bandwidth, frame_rate.
void list_options(SendQueueOptions& options, OptionTable& table);

/// A frame that waits to be encoded.
struct QueuedFrame {
  Stamp stamp = 0;
  std::string frame_id;
  std::uint32_t exchange = 0;
  bool sparse = false;
  std::string reference;      ///< sparse: robot whose frame the station needs to rebuild this one
  Stamp reference_stamp = 0;  ///< sparse: names that robot's frame
  std::uint64_t ticket = 0;   ///< the caller's name for what is to be encoded
};

/// What to encode next.
struct EncodeOrder {
  QueuedFrame frame;
  bool as_whole = false;  ///< the frame was to be sparse, but the station lacks its reference
  std::size_t limit = 0;  ///< of the encoded frame [bytes]; 0: no limit
};

/// What to put on the radio now, as rprr_msgs/EncodedFrame.
struct SendOrder {
  Stamp stamp = 0;
  std::string frame_id;  ///< empty in all chunks but the first
  std::uint32_t exchange = 0;
  Bytes data;  ///< a container, or a chunk of one
};

/// Decides when one robot's frames are encoded and sent. It keeps a byte budget, sends the newest
/// frame first and in chunks at an even pace, and sends nothing that is predicted from a reference
/// which the station lacks.
///
/// On a narrow radio (with a bandwidth, or where receipts take long) a frame waits until the frame
/// before it is through. Of each kind (whole, sparse) only the newest frame waits, and it is
/// encoded as late as possible. Without a bandwidth the receipts tell how fast the radio is.
/// Messages of the exchange are never held back: they are counted (spent) and frames make room for
/// them.
///
/// Errors: receipts come over the radio; whatever they say, memory is bounded.
/// Threads: none of its own, and no clock; one thread at a time.
class SendQueue {
 public:
  explicit SendQueue(SendQueueOptions options);

  /// Changes bandwidth and frame_rate of the options.
  void set_rate(double bandwidth, double frame_rate);

  /// Takes a frame up. Returns the frames that gave way and will not be sent.
  std::vector<QueuedFrame> offer(QueuedFrame frame, SteadyTime now);
  /// Bytes that this robot's other messages put on the radio.
  void spent(std::size_t bytes, SteadyTime now);
  /// The station's word on a robot's frames: whole ones held, ones to repeat, the last that came.
  void receipt(const std::string& robot, const std::vector<Stamp>& held,
               const std::vector<Stamp>& repeat, Stamp last, SteadyTime now);

  /// Somebody new listens: what was on its way to others will not be acknowledged.
  void listener_joined() { in_flight_.clear(); }

  /// What to encode now, if anything: then encoded() or failed() must follow.
  std::optional<EncodeOrder> next_to_encode(SteadyTime now);
  void encoded(const EncodeOrder& order, Bytes data, SteadyTime now);
  void failed() { encoding_ = false; }

  /// What to send now, if anything; call until there is none.
  std::optional<SendOrder> next_to_send(SteadyTime now);

  LinkState link_state(SteadyTime now);
  /// Seconds until everything that is encoded is sent.
  double backlog(SteadyTime now);
  std::size_t waiting() const { return queue_.size(); }
  /// Whether there is a bandwidth, or receipts tell that a frame as it is usually takes long.
  bool is_narrow() const {
    return limited() || (delivery_rate_ > 0.0 && usual_bytes_ > kSlow * delivery_rate_);
  }
  /// Frames that were sent again so far.
  std::size_t repeated() const { return repeated_; }
  /// The station did send receipts, and sends none any more.
  bool receipts_ceased(SteadyTime now) const {
    return options_.receipt_timeout > 0 && last_receipt_ && !hears_receipts(now);
  }

 private:
  struct Entry {
    QueuedFrame frame;
    SteadyTime offered;
  };
  struct Reference {  // that a sparse frame waits or waited for
    Stamp stamp = 0;
    SteadyTime since;
  };
  struct Message {
    Stamp stamp = 0;
    std::string frame_id;
    std::uint32_t exchange = 0;
    Bytes data;
    std::uint16_t number = 0;
    bool whole = false;
    bool repeated = false;
    SteadyTime begun;
    std::size_t next = 0;  // chunk
  };
  struct Sent {
    Stamp stamp = 0;
    SteadyTime begun;
    SteadyTime at;  // when its last byte was handed over
    std::size_t bytes = 0;
    bool whole = false;
  };
  struct Kept {
    Message message;
    std::optional<SteadyTime> repeated;
  };

  bool limited() const { return options_.bandwidth > 0.0; }
  bool hears_receipts(SteadyTime now) const;
  bool is_held(const std::string& robot, Stamp stamp) const;
  bool may_go(const Entry& entry, SteadyTime now) const;
  bool window_is_full(SteadyTime now) const;
  Duration lost_after() const;
  Duration reference_patience() const;
  std::size_t frame_limit();
  std::size_t chunk_size() const;
  std::size_t bytes_left() const;
  void sent_all(std::size_t bytes, SteadyTime now);
  void acknowledge(Stamp last, const std::vector<Stamp>& held, SteadyTime now);
  void learn(const Sent& sent, SteadyTime now);
  void learn_wait(const std::vector<Stamp>& held, SteadyTime now);
  void repeat(Stamp stamp, SteadyTime now);

  static constexpr double kSlow = 0.5;  // seconds for a frame

  SendQueueOptions options_;
  RateLimit rate_;
  std::deque<Entry> queue_;  // oldest first
  bool encoding_ = false;
  bool last_was_sparse_ = false;
  std::deque<Message> outgoing_;  // encoded, not all of it sent
  std::uint16_t next_number_;
  std::deque<Sent> in_flight_;
  std::deque<Kept> kept_;                           // whole frames that may be asked for again
  std::deque<Stamp> own_sent_;                      // whole frames
  std::map<std::string, std::vector<Stamp>> held_;  // of this robot and its references
  std::optional<SteadyTime> last_receipt_;
  std::deque<Reference> awaited_;  // oldest first
  double receipt_seconds_ = 0.0;   // from handing a frame over to its receipt, smoothed
  double whole_seconds_ = 0.0;     // from encoding a whole frame to its receipt [s], smoothed
  double usual_bytes_ = 0.0;       // of a frame that is not coarsened [bytes], smoothed
  SteadyTime acknowledged_at_;
  double delivery_rate_ = 0.0;      // [bytes/s], smoothed; 0: not known
  double reference_seconds_ = 0.0;  // until the receipt of a reference comes [s], smoothed
  double control_per_frame_ = 0.0;  // bytes of other messages between frames, smoothed
  std::size_t control_ = 0;         // since the last frame
  std::size_t longest_control_ = 0;
  std::size_t repeated_ = 0;
};

}  // namespace rprr
