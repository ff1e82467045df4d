// SPDX-License-Identifier: BSD-3-Clause
#include "rprr_eval/poses/methods.hpp"

#include <algorithm>

#include "rprr_eval/exchange/exchange_registration.hpp"
#include "rprr_eval/poses/peers.hpp"
#include "rprr_eval/profile/profile.hpp"

namespace rprr {
namespace {

using Made = Result<std::unique_ptr<Registration>>;

Made protocol(const std::string& name, const std::string& profile_name, bool use_previews) {
  Result<Profile> profile = load_profile(profile_name);
  if (!profile) return Error{profile.reason()};
  profile->use_previews = use_previews;
  return make_exchange_registration(name, *profile);
}

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> kMethods = {
      {"preview", "the preview protocol, profile default, cold",
       [] { return protocol("preview", "default", true); }},
      {"samples", "the samples protocol, profile default",
       [] { return protocol("samples", "default", false); }},
      {"samples_paper", "the samples protocol, profile paper",
       [] { return protocol("samples_paper", "paper", false); }},
      {"icp_bd", "the paper's ICP-BD", [] { return Made(make_icp_bd()); }},
      {"icp_ivd", "ICP in inverse depth coordinates (Lui et al.)",
       [] { return Made(make_icp_ivd()); }},
      {"icp", "standard ICP (Besl and McKay)", [] { return Made(make_icp()); }},
      {"pcl_plane", "PCL point-to-plane ICP", make_pcl_point_to_plane},
      {"pcl_gicp", "PCL generalised ICP", make_pcl_gicp},
      {"orb_pnp", "500 ORB features and PnP", make_orb_pnp},
      {"open3d_fgr", "Open3D fast global registration", make_open3d_fgr},
  };
  return kMethods;
}

Result<NamedRegistrations> make_methods(const std::vector<std::string>& names,
                                        std::vector<std::string>& notes) {
  std::vector<std::string> wanted = names;
  if (wanted.empty()) {
    for (const Method& method : methods()) wanted.push_back(method.name);
  }
  NamedRegistrations made;
  for (const std::string& name : wanted) {
    const auto method = std::find_if(methods().begin(), methods().end(),
                                     [&](const Method& m) { return m.name == name; });
    if (method == methods().end()) {
      std::string known;
      for (const Method& m : methods()) known += " " + m.name;
      return Error{"no method " + name + "; there are" + known};
    }
    Made registration = method->make();
    if (registration) {
      made.push_back(std::move(*registration));
    } else if (names.empty()) {
      notes.push_back(name + ": " + registration.reason());
    } else {
      return Error{name + ": " + registration.reason()};
    }
  }
  return made;
}

}  // namespace rprr
