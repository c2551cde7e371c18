// Soil columns under waves that come up through an absorbing base or with a rigid one. References: d'Alembert, and
// transfer functions of layers made here by the recursion of up- and downgoing waves (Haskell 1953; Kramer, Geotechnical Earthquake
// Engineering, 1996, section 7.2): at the top of each layer u = A e^{ikz} + B e^{-ikz}, at the free surface A = B.
#include <gtest/gtest.h>

#include "manual.h"
#include "mesh_support.h"

namespace uplift::verification::mesh_column_test {
namespace {

using Complex = std::complex<double>;

struct Layer {
  double thickness, speed, density, beta;  // m, m/s of the wave in question, kg/m3, s (G is complex: G (1 + i w beta))
};

/// Surface motion over the motion of the free rock's surface at the depth of the base; the last layer has the material of the rock.
Complex transfer(const std::vector<Layer>& layers, double omega) {
  Complex up = 1, down = 1;
  const auto speed = [&](const Layer& l) { return l.speed * std::sqrt(Complex(1, omega * l.beta)); };
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Complex shift = std::exp(Complex(0, 1) * omega / speed(layers[i]) * layers[i].thickness);
    const Layer& below = layers[std::min(i + 1, layers.size() - 1)];
    const Complex ratio = i + 1 == layers.size() ? Complex(1) : layers[i].density * speed(layers[i]) / (below.density * speed(below));
    const Complex a = up * shift, b = down / shift;
    up = 0.5 * (a * (1.0 + ratio) + b * (1.0 - ratio));
    down = 0.5 * (a * (1.0 - ratio) + b * (1.0 + ratio));
  }
  return 1.0 / up;  // A = B = 1: the surface moves 2, the outcrop 2 A of the rock
}

double total(const std::vector<Layer>& layers) {
  double sum = 0;
  for (const Layer& layer : layers) sum += layer.thickness;
  return sum;
}

/// Columns of cells one wide (`wide`: more), surface at 0, elements that a wave crosses in `travel` s.
struct Column {
  std::vector<Layer> layers;
  Cell cell = Cell::quad4;
  std::string wave = "SV";
  double travel = 4e-3, duration = 1, frequency = 4, azimuth = 0;  // s, s, Hz, rad
  bool rigid = false;                                              // base held, moved by inertia forces
  int wide = 1;
  double poisson = 0.3;

  int dimension() const { return info(cell).dimension; }
  double step() const { return travel / 2; }

  Mesh mesh() const {
    std::vector<double> up{-total(layers)};
    std::vector<int> part;
    std::vector<std::string> names;
    for (std::size_t i = layers.size(); i-- > 0;) {
      const int n = static_cast<int>(std::ceil(layers[i].thickness / layers[i].speed / travel - 1e-9));
      const double from = up.back(), to = i == 0 ? 0 : from + layers[i].thickness;
      for (int k = 1; k <= n; ++k) up.push_back(from + (to - from) * k / n), part.push_back(static_cast<int>(names.size()));
      names.push_back(fmt::format("layer_{}", i));
    }
    const std::vector<double> across = uniform_lines(0, wide, wide);
    const bool plane = dimension() == 2;
    const Grid lines{across, plane ? up : across, plane ? std::vector<double>{} : up};
    const auto part_at = [&](int, int j, int k) { return part[static_cast<std::size_t>(plane ? j : k)]; };
    const auto face = [&](int, Direction direction, int other) { return other < 0 ? std::string(name_of(direction)) : std::string(); };
    return with_cells(grid(lines, part_at, names, face), cell);
  }

  /// What stays free is the particle motion; wide columns are held at their sides only.
  std::string supports() const {
    const bool plane = dimension() == 2;
    std::string text;
    const auto hold = [&](const std::string& group, const std::string& fixed) {
      text += fmt::format("[[support]]\ngroup = \"{}\"\nfixed = [{}]\n", group, fixed);
    };
    const std::string up = plane ? "\"uy\"" : "\"uz\"";
    if (wide > 1) {
      hold("left", up), hold("right", up);
      if (!plane) hold("front", "\"uy\""), hold("back", "\"uy\"");
      return text;
    }
    std::string fixed = wave == "P" ? "\"ux\"" : up;
    if (!plane && azimuth == 0) fixed += wave == "SH" ? ", \"ux\"" : ", \"uy\"";
    for (std::size_t i = 0; i < layers.size(); ++i) hold(fmt::format("layer_{}", i), fixed);
    return text;
  }

  std::string text() const {
    const bool plane = dimension() == 2;
    std::string out = "title = \"column\"\n[mesh]\nfile = \"column.msh\"\n" + supports();
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const double shear = layers[i].speed / (wave == "P" ? std::sqrt((2 - 2 * poisson) / (1 - 2 * poisson)) : 1);
      out +=
          fmt::format("[[solid]]\ngroup = \"layer_{}\"\nshear_wave_speed = {:.17g}\npoisson = {}\ndensity = {}\ndamping_beta = {:.17g}\n",
                      i, shear, poisson, layers[i].density, layers[i].beta);
    }
    if (rigid) {
      out +=
          "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\"]\n[[ground_acceleration]]\ndirection = " + triple(Vec3(1, 0, 0), dimension()) +
          "\nfunction = \"wave\"\n";
    } else {
      out += fmt::format("[[absorbing]]\ngroup = \"bottom\"\nincident = {{ wave = \"{}\", kind = \"outcrop\", function = \"wave\"{} }}\n",
                         wave, azimuth != 0 ? fmt::format(", azimuth = {:.17g}", azimuth) : "");
    }
    out += fmt::format("[[function]]\nname = \"wave\"\nshape = {{ type = \"ricker\", frequency = {} }}\n", frequency);
    // all that holds the column at rest: a spring of 3e-9 of the soil's stiffness
    const Vec3 along = wave == "P" ? (plane ? Vec3(0, 1, 0) : Vec3(0, 0, 1)) : wave == "SH" ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
    std::string held = "\"mesh.1\"";
    if (azimuth != 0) held += ", \"mesh.2\"";  // against twisting, too
    if (rigid) held = fmt::format("\"mesh.{}\"", nodes_where(mesh(), [&](const Vec3& x) { return x[plane ? 1 : 2] > -1e-9; }).front() + 1);
    out += fmt::format(
        "[[interface]]\nname = \"hold\"\npairs = {{ upper = [{}], normal = {}, area = 1 }}\nlaw = {{ type = \"elastic\", K_n = {:.3g}, "
        "tangential = \"{}\" }}\n",
        held, triple(along, dimension()), 3e-9 * layers[0].density * layers[0].speed * layers[0].speed, azimuth != 0 ? "bonded" : "none");
    out += fmt::format("[[stage]]\ntype = \"dynamic\"\nduration = {}\nstep = {}\n", duration, step());
    out += "[energy]\ncreated_limit = 1e9\n[output]\nautomatic = false\nenergies = false\nframes = 0\n";
    for (const char* word : {"vx", "vy", "vz", "ax"})
      if (word[1] != 'z' || !plane)
        out += fmt::format("[[output.history]]\nname = \"{}\"\nat = {}\nquantity = \"{}\"\n", word,
                           triple(plane ? Vec3(wide / 2, 0, 0) : Vec3(wide / 2, wide / 2, 0), dimension()), word);
    return out;
  }

  MeshRun run() const {
    MeshRun made = run_mesh(text(), mesh());
    EXPECT_TRUE(made.completed()) << made.result.reason;
    return made;
  }
};

/// Largest error of the transfer function over the frequencies, relative to the largest value.
double transfer_error(const Column& column, const std::string& quantity) {
  const MeshRun run = column.run();
  std::vector<double> input;
  for (const double t : run.time()) input.push_back(ricker(column.frequency, t));
  double error = 0, largest = 0;
  for (double f = 0.5; f < 6.01; f += 0.25) {
    const Complex exact = transfer(column.layers, 2 * pi * f);
    const Complex found = fourier(run.time(), run[quantity], 2 * pi * f) / fourier(run.time(), input, 2 * pi * f);
    error = std::max(error, std::abs(found - exact));
    largest = std::max(largest, std::abs(exact));
  }
  return error / largest;
}

// the speeds are those of the wave that runs through
const std::vector<Layer> ground{{6, 150, 1700, 3e-3}, {10, 250, 1850, 2e-3}, {8, 200, 1800, 4e-3}, {8, 800, 2200, 0}};

// Claim (own transfer matrix against a published table): H = 20 m, Vs = 200 m/s, rho = 1900 on rock 2200, 800 m/s, undamped:
// 4.631579 at 2.5 Hz. This checks the reference, not the program.
TEST(MeshColumn, TheTransferMatrixGivesTheClosedForm) {
  VERIFIES({"Waves in soil", "Transfer function of the reference against its closed form",
            "Kramer, Geotechnical Earthquake Engineering (1996), section 7.2; tests/data/reference/soil_column_transfer.csv"});
  VERIFY_NEAR("amplification at 2.5 Hz", "1", std::abs(transfer({{20, 200, 1900, 0}, {5, 800, 2200, 0}}, 2 * pi * 2.5)), 4.631579, 5e-7);
  const Reference table = reference("soil_column_transfer.csv");
  const std::vector<double>& f = table["f_Hz"];
  for (std::size_t i = 0; i < f.size(); i += 7)
    VERIFY_NEAR("amplification, table", "1", std::abs(transfer({{20, 200, 1900, 0}, {5, 800, 2200, 0}}, 2 * pi * f[i])),
                table["elastic_rock_undamped"][i], 1e-9);
}

// Claim: uniform rock: the free surface moves as the outcrop, later by H/c: 1e-3 of the peak, order 2 in h and dt together; 2D and 3D, P,
// SV and SH.
TEST(MeshColumn, SurfaceOfUniformRockIsTheOutcrop) {
  VERIFIES({"Waves in soil", "Surface of uniform rock on an absorbing base", "d'Alembert: the outcrop motion, later by H/c"});
  struct Kind {
    Cell cell;
    const char *wave, *quantity;
  };
  for (const auto& [cell, wave, quantity] : {Kind{Cell::quad4, "SV", "vx"},
                                             {Cell::quad4, "P", "vy"},
                                             {Cell::hex8, "SV", "vx"},
                                             {Cell::hex8, "SH", "vy"},
                                             {Cell::hex8, "P", "vz"}}) {
    std::vector<double> size, error;
    for (const double travel : {2e-3, 1e-3}) {
      Column column{{{40, 800, 2200, 0}}, cell, wave, travel, 0.8};
      const MeshRun run = column.run();
      double worst = 0;
      for (std::size_t i = 0; i < run.time().size(); ++i)
        worst = std::max(worst, std::abs(run[quantity][i] - ricker(column.frequency, run.time()[i] - 40.0 / 800)));
      size.push_back(travel), error.push_back(worst);
    }
    RecordProperty(std::string(wave) + "_" + std::string(info(cell).name),
                   fmt::format("{:.2e} {:.2e} order {:.2f}", error[0], error[1], order(size, error)));
    VERIFY_LT("largest error over the peak, finer mesh", "1", error[1], 1e-3) << info(cell).name << wave;
    verified_case.curve(fmt::format("{} {}", info(cell).name, wave), size, error);
    VERIFY_NEAR("order of convergence", "1", order(size, error), 2, 0.2) << info(cell).name << wave;
  }
}

// Claim: three damped layers on rock against the transfer matrix, amplitude and phase from 0.5 to 6 Hz: 5e-3 of the peak on the finer mesh,
// order 2. The speeds are those of the wave (S or P).
TEST(MeshColumn, LayersMatchTheTransferMatrix) {
  VERIFIES({"Waves in soil", "Three damped layers on rock",
            "Recursion of up- and downgoing waves (Haskell, BSSA 43 (1953) 17-34; Kramer (1996), section 7.2)"});
  struct Kind {
    Cell cell;
    const char *wave, *quantity;
  };
  for (const auto& [cell, wave, quantity] : {Kind{Cell::quad4, "SV", "vx"}, {Cell::hex8, "SV", "vx"}, {Cell::hex8, "P", "vz"}}) {
    std::vector<double> size, error;
    for (const double travel : {8e-3, 4e-3}) {
      Column column{ground, cell, wave, travel, 6.0};
      size.push_back(travel), error.push_back(transfer_error(column, quantity));
    }
    RecordProperty(std::string(wave) + "_" + std::string(info(cell).name),
                   fmt::format("{:.2e} {:.2e} order {:.2f}", error[0], error[1], order(size, error)));
    VERIFY_LT("largest error over the peak, finer mesh", "1", error[1], 5e-3) << info(cell).name << wave;
    verified_case.curve(fmt::format("{} {}", info(cell).name, wave), size, error);
    VERIFY_NEAR("order of convergence", "1", order(size, error), 2, 0.2) << info(cell).name << wave;
  }
}

// Claim: a rigid base with 5 % damping at f1 and 3 f1: amplification 12.763146 and 4.220223 (the stiffness is complex, G (1 + i w beta), so
// at that frequency viscous and hysteretic damping are the same): 5e-3.
TEST(MeshColumn, RigidBaseAmplifiesByTheTable) {
  VERIFIES({"Waves in soil", "Damped layer on a rigid base", "Kramer (1996), section 7.2: 1/|cos(ωH/c*)|"});
  for (const auto& [k, value] : {std::pair{1, 12.763146}, std::pair{3, 4.220223}}) {
    const double omega = 2 * pi * 2.5 * k, beta = 2 * 0.05 / omega;
    // the closed form, |1/cos(omega H/Vs*)|, gives the table
    VERIFY_NEAR("closed form of the amplification", "1", std::abs(1.0 / std::cos(omega * 20.0 / (200.0 * std::sqrt(Complex(1, 0.1))))),
                value, 5e-7);
    Column column{{{20, 200, 1900, beta}}, Cell::quad8, "SV", 1e-2 / k, k == 1 ? 14.0 : 40.0, 2.5 * k};
    column.rigid = true;
    const MeshRun run = column.run();
    std::vector<double> input;
    for (const double t : run.time()) input.push_back(ricker(column.frequency, t));
    std::vector<double> middle = run.time();  // there is an interface: accelerations are means over the step
    for (double& t : middle) t -= column.step() / 2;
    const Complex found = 1.0 + fourier(middle, run["ax"], omega) / fourier(run.time(), input, omega);
    RecordProperty(fmt::format("mode_{}", k), fmt::format("{:.6f}", std::abs(found)));
    VERIFY_NEAR("amplification", "1", std::abs(found), value, 5e-3 * value);
  }
}

// Claim: no structure: a wide soil mass whose sides are held against vertical motion gives back the free field of the column, 1e-8 of the
// peak (the same equations but for the spring).
TEST(MeshColumn, WithoutStructureTheFreeFieldComesBack) {
  VERIFIES({"Waves in soil", "Wide soil without a structure", "The column of one cell: the same equations"});
  for (const Cell cell : {Cell::quad4, Cell::hex8}) {
    Column narrow{ground, cell, "SV", 1e-2, 1.0};
    Column wide = narrow;
    wide.wide = 4;
    const MeshRun one = narrow.run(), many = wide.run();
    double worst = 0, vertical = 0;
    for (std::size_t i = 0; i < one.time().size(); ++i) {
      worst = std::max(worst, std::abs(one["vx"][i] - many["vx"][i]));
      vertical = std::max(vertical, std::abs(many[cell == Cell::quad4 ? "vy" : "vz"][i]));
    }
    VERIFY_LT("largest difference of the horizontal velocity", "m/s", worst, 1e-8 * one.peak("vx"));
    VERIFY_LT("largest vertical velocity", "m/s", vertical, 1e-9 * one.peak("vx"));
    VERIFY_GT("largest velocity of the surface", "m/s", one.peak("vx"), 1);  // softer soil moves more than the rock's outcrop
  }
}

// Claim: an S wave with an azimuth moves the surface along that azimuth: components in the ratio of cosine and sine, 1e-8 of the peak.
TEST(MeshColumn, AzimuthTurnsTheMotion) {
  VERIFIES({"Waves in soil", "Azimuth of an S wave", "Components of the motion along x: cos and sin"});
  Column along{ground, Cell::hex8, "SV", 1e-2, 1.0}, turned = along;
  turned.azimuth = 37 * pi / 180;
  const MeshRun one = along.run(), other = turned.run();
  double worst = 0;
  for (std::size_t i = 0; i < one.time().size(); ++i)
    worst = std::max({worst, std::abs(other["vx"][i] - std::cos(turned.azimuth) * one["vx"][i]),
                      std::abs(other["vy"][i] - std::sin(turned.azimuth) * one["vx"][i])});
  VERIFY_LT("largest difference of the velocities", "m/s", worst, 1e-8 * one.peak("vx"));
}

}  // namespace
}  // namespace uplift::verification::mesh_column_test
