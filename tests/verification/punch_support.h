#pragma once
#include "mesh_support.h"

// What the verification cases of rigid bodies on meshed ground share.
namespace uplift::verification {

/// A rigid body over nodes of the ground's surface.
struct Punch {
  double young = 1e8, poisson = 0.3;  // Pa, 1
  std::string supports;               // of the ground
  std::string master;                 // "fixed" list of the master node
  std::string extra;                  // loads, motions
  std::string law = "\"unilateral\"";
  double height = 1;                                                                 // m, of the master above the ground
  std::string gap;                                                                   // lines of the interface on the initial gap
  std::function<double(const Vec3&)> drawn_above = [](const Vec3&) { return 0.0; };  // m: nodes of the body above those of the ground
};

inline std::string punch_text(const Punch& punch, const Mesh& mesh, const std::vector<int>& touching, double area) {
  const int d = mesh.dimension;
  std::string out = "title = \"punch\"\n[mesh]\nfile = \"ground.msh\"\n[nodes]\nmaster = " +
                    triple(d == 2 ? Vec3(0, punch.height, 0) : Vec3(0, 0, punch.height), d) + "\n";
  std::string slaves;
  for (std::size_t i = 0; i < touching.size(); ++i) {
    Vec3 place = mesh.nodes[static_cast<std::size_t>(touching[i])];
    place[d - 1] += punch.drawn_above(place);
    out += fmt::format("s{} = {}\n", i, triple(place, d));
    slaves += fmt::format("{}\"s{}\"", i ? ", " : "", i);
  }
  out += fmt::format("[[solid]]\ngroup = \"volume\"\nE = {:.17g}\npoisson = {}\ndensity = 1000\n", punch.young, punch.poisson) +
         punch.supports;
  out += fmt::format("[[rigid]]\nname = \"punch\"\nnode = \"master\"\nslaves = [{}]\nmass = 1\ninertia = 1\n", slaves);
  out += fmt::format("[[support]]\nnode = \"master\"\nfixed = [{}]\n", punch.master);
  out += fmt::format("[[interface]]\nname = \"foot\"\npairs = {{ upper = [{}], lower = {}, area = {:.17g} }}\nlaw = {}\n{}", slaves,
                     names_of(touching), area, punch.law, punch.gap);
  return out + punch.extra +
         "[[stage]]\ntype = \"static\"\nsteps = 1\n[[stage]]\ntype = \"dynamic\"\nduration = 1e-7\nstep = 1e-7\n[energy]\ncreated_limit = "
         "1e9\n[limits]\nrotation = 1\n[output]\nframes = 0\nenergies = false\n";
}

inline std::string fixed(const std::string& group, const std::string& unknowns) {
  return fmt::format("[[support]]\ngroup = \"{}\"\nfixed = [{}]\n", group, unknowns);
}

inline std::vector<double> downwards(std::vector<double> depths) {
  std::ranges::reverse(depths);
  for (double& z : depths) z = -z;
  return depths;
}

/// Tractions of the points [Pa]: p0, p1, ... normal (tension > 0), with friction in the plane q0, q1, ... tangential.
inline void watch_tractions(BuiltCase& built) {
  const Interface& foot = built.model.interfaces.front();
  for (int i = 0; i < foot.batch.points; ++i)
    for (int c = 0; c < foot.batch.components; ++c) {
      Request request;
      request.kind = Request::Kind::traction;
      request.name = fmt::format("{}{}", c + 1 == foot.batch.components ? 'p' : 'q', i);
      request.point = i;
      request.component = c;
      built.plan.requests.push_back(request);
    }
}

}  // namespace uplift::verification
