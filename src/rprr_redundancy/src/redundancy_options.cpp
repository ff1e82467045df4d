// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_redundancy/redundancy_options.hpp"

#include <algorithm>

namespace rprr {

void list_options(RedundancyOptions& o, OptionTable& table) {
  constexpr OptionRange kShare = {0.0, 1.0};
  table.group("What the reference asks for, where it has a preview");
  table.number("decision_least_coverage", o.decision.least_coverage, kShare, "",
               "A block is covered if this share of its 2x2 cells holds a warped pixel");
  table.number(
      "decision_least_agreement", o.decision.least_agreement, kShare, "",
      "Depths agree if this share of a block's warped pixels lies near the preview's depth");
  table.number("decision_depth_tolerance", o.decision.depth_tolerance, {0.0, 10.0}, "m",
               "How far from the preview's depth is near");
  table.number("decision_depth_tolerance_share", o.decision.depth_tolerance_share, kShare, "",
               "What is added to that, as a share of the depth");
  table.number("decision_colour_tolerance", o.decision.colour_tolerance, {0.0, 255.0},
               "grey levels", "Difference of colours that the preview's coding explains");
  table.number("decision_colour_sigmas", o.decision.colour_sigmas, {0.0, 100.0}, "",
               "What is added to that, in units of the robust spread of the frame's blocks");
  table.group("What the dependent adds and waits for");
  table.whole("validation_min_pixels", o.validation.min_pixels, {1, 64}, "pixels",
              "A block is in B_v once so many of its valid pixels leave the reference's view; the "
              "paper: 1");
  table.seconds("prediction_timeout", o.outgoing.prediction_timeout, {0.0, 60.0},
                "How long a frame with an accepted pose waits for the reference's block request; "
                "then it goes out whole");
}

void list_options(RedundancyWiring& o, OptionTable& table) {
  table.group("The robot");
  table.robot("robot", o.robot, "This robot; its topics are in /ROBOT").as_wiring();
  table.texts("peers", o.peers, "Robots that this one exchanges with")
      .as_wiring()
      .only_if(are_robot_names, kRobotNamesRule);
  table.flag("link_recovery", o.link_recovery,
             "Make subscriptions to peers anew when their host answers again after a silence; "
             "false: left to TCP, which may take as long again as the silence was");
}

std::string problem_of(const RedundancyWiring& wiring) {
  const std::vector<std::string>& peers = wiring.peers;
  if (std::find(peers.begin(), peers.end(), wiring.robot) == peers.end()) return {};
  return "peers: " + wiring.robot + " is this robot itself, allowed: other robots";
}

}  // namespace rprr
