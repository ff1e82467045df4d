// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_radio/send_queue.hpp"

namespace rprr {
namespace {

bool is_bandwidth(const OptionValue& value) {
  const double bandwidth = std::get<double>(value);
  return bandwidth == 0.0 || bandwidth >= kLeastBandwidth;
}

}  // namespace

void list_options(SendQueueOptions& o, OptionTable& table) {
  table.group("The radio");
  table
      .number("bandwidth", o.bandwidth, {0.0, 1e9}, "bytes/s",
              "What this robot may put on its radio, exchange and frames together, kept over any "
              "two seconds. Counted are serialised messages; TCP/IP adds 5 to 10%")
      .as_live()
      .only_if(is_bandwidth, "0 (no limit), or 8000 to 1000000000 bytes/s");
  table
      .number("frame_rate", o.frame_rate, {0.0, 60.0}, "frames/s",
              "On a narrow radio (a bandwidth, or slow receipts) colours are coarsened rather than "
              "that fewer frames are sent; they keep a fifth of the frame. 0: never coarsened")
      .as_live();
  table.whole(
      "in_flight", o.in_flight, {0, 1000}, "frames",
      "No exchange begins while the station, if it sends receipts, has so many frames still "
      "to acknowledge; 0: any number");
  table.seconds(
      "receipt_timeout", o.receipt_timeout, {0.0, 3600.0},
      "How long a sparse frame waits for the station's receipt of its reference before it "
      "goes out whole; 0: receipts are not waited for");
  table.whole("queue_size", o.waiting, {1, 1000}, "frames",
              "How many frames may wait; then the oldest is dropped. On a narrow radio only the "
              "newest of each kind waits");
}

}  // namespace rprr
