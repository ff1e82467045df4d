// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_pose/exchange_stage.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "rprr_pose/director.hpp"
#include "rprr_pose/samples_wire.hpp"
#include "rprr_pose/update_wire.hpp"

namespace rprr {
namespace {

// With protocol samples both parts of a robot hear the same kinds of message, and exchanges that
// either side began may have the same number: who it is from tells them apart.
bool is_for_reference(const PoseMessage& message) {
  if (const auto* samples = std::get_if<SamplesMessage>(&message)) {
    return are_of_dependent(samples->data);
  }
  const auto* update = std::get_if<UpdateMessage>(&message);
  return update != nullptr && is_of_dependent(update->data);
}

}  // namespace

ExchangeStage::ExchangeStage(const std::string& robot, const ExchangeOptions& options,
                             const std::vector<std::string>& peers, PosePrior prior)
    : use_previews_(options.use_previews) {
  for (const std::string& name : peers) {
    Peer& peer = peers_[name];
    if (use_previews_) {
      peer.as_dependent.role = make_preview_dependent(robot, name, options.preview);
    } else {
      peer.as_dependent.role = make_samples_dependent(robot, name, options.samples);
      peer.as_reference.role = make_samples_reference(robot, name, options.samples);
    }
    peer.as_dependent.role->set_active(false);
  }
  if (!use_previews_) return;
  auto director = std::make_unique<Director>(robot, options.preview, std::move(prior));
  for (const std::string& name : peers) director->add_dependent(name);
  director_.role = std::move(director);
}

bool ExchangeStage::set_reference(const std::string& name, bool refer) {
  const auto found = peers_.find(name);
  if (found == peers_.end()) return false;
  Peer& peer = found->second;
  peer.refer = refer;
  peer.as_dependent.role->set_active(refer);
  if (peer.as_reference.role) peer.as_reference.role->set_active(!refer);
  return true;
}

bool ExchangeStage::refers_to(const std::string& name) const {
  const auto found = peers_.find(name);
  return found != peers_.end() && found->second.refer;
}

void ExchangeStage::offer(const RgbdFramePtr& frame, SteadyTime now, RoleOutput& out) {
  if (newest_ && frame->stamp < *newest_) ++epoch_;
  newest_ = frame->stamp;
  const Action offer = [&](ExchangeRole& role, RoleOutput& output) {
    role.offer(frame, now, output);
  };
  drive(director_, out, offer);
  for (Peer* peer : in_turn()) {
    const std::size_t before = out.send.size();
    drive(peer->as_reference, out, offer);
    drive(peer->as_dependent, out, offer);
    if (use_previews_ && out.send.size() > before) {
      ++turn_;
      break;
    }
  }
}

void ExchangeStage::receive(const std::string& name, const PoseMessage& message, SteadyTime now,
                            RoleOutput& out) {
  const auto found = peers_.find(name);
  if (found == peers_.end()) return;
  const Action receive = [&](ExchangeRole& role, RoleOutput& output) {
    role.receive(name, message, now, output);
  };
  drive(director_, out, receive);
  Peer& peer = found->second;
  drive(is_for_reference(message) ? peer.as_reference : peer.as_dependent, out, receive);
}

void ExchangeStage::tick(SteadyTime now, RoleOutput& out) {
  drive_all(out, [now](ExchangeRole& role, RoleOutput& output) { role.tick(now, output); });
}

// A frame that waited for the radio is asked about at one reference, too.
void ExchangeStage::set_link_state(const LinkState& link, SteadyTime now, RoleOutput& out) {
  LinkState left = link;
  const Action set = [&](ExchangeRole& role, RoleOutput& output) {
    role.set_link_state(left, now, output);
  };
  drive(director_, out, set);
  for (Peer* peer : in_turn()) {
    const std::size_t before = out.send.size();
    drive(peer->as_reference, out, set);
    drive(peer->as_dependent, out, set);
    if (!use_previews_ || out.send.size() == before) continue;
    ++turn_;
    left.has_room = false;
  }
}

void ExchangeStage::drive_all(RoleOutput& out, const Action& action) {
  drive(director_, out, action);
  for (auto& [name, peer] : peers_) {
    drive(peer.as_reference, out, action);
    drive(peer.as_dependent, out, action);
  }
}

// The director answers within one call, so what its other calls take belongs to no decision. The
// other parts' exchanges take several calls.
void ExchangeStage::drive(Part& part, RoleOutput& out, const Action& action) const {
  if (!part.role) return;
  const std::size_t before = out.decisions.size();
  const auto start = std::chrono::steady_clock::now();
  action(*part.role, out);
  part.ms +=
      std::chrono::duration<float, std::milli>(std::chrono::steady_clock::now() - start).count();
  for (std::size_t i = before; i < out.decisions.size(); ++i) {
    out.decisions[i].ms_pose = part.ms;
    out.decisions[i].epoch = epoch_;
  }
  if (&part == &director_ || out.decisions.size() > before) part.ms = 0.0f;
}

// All peers, beginning with another one after each frame that was asked about.
std::vector<ExchangeStage::Peer*> ExchangeStage::in_turn() {
  std::vector<Peer*> peers;
  for (auto& [name, peer] : peers_) peers.push_back(&peer);
  if (peers.empty()) return peers;
  const auto first = static_cast<std::ptrdiff_t>(turn_ % peers.size());
  std::rotate(peers.begin(), peers.begin() + first, peers.end());
  return peers;
}

}  // namespace rprr
