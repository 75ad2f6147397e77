#include "geodesic_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bowstring::geodesics {
namespace {

/// q, x, δx and η, the last two component by component, six columns each.
struct State {
  static constexpr std::size_t size = 4 + 3 + 18 + 18;
  static constexpr std::size_t q = 0, x = 4, by_x = 7, by_eta = 25;
  std::array<double, size> data{};
};

struct Equations {
  Vector3 m, p;
  double compliance;

  /// data' of the state.
  void operator()(const State& state, State& rate) const noexcept {
    const double* s = state.data.data();
    double* out = rate.data.data();
    const lie::Rotation q = lie::Rotation::load(s + State::q);
    const Vector3 x = Vector3::load(s + State::x);
    const Vector3 angular = m - cross(x, p);
    const Vector3 t = q.first_axis();
    const double horizontal = 1.0 - compliance, along = dot(p, t);

    const lie::Rotation turned = lie::Rotation{0.0, 0.5 * angular[0], 0.5 * angular[1], 0.5 * angular[2]} * q;
    turned.store(out + State::q);
    (compliance * p + horizontal * along * t).store(out + State::x);

    const double* dx = s + State::by_x;
    const double* eta = s + State::by_eta;
    double* dx_rate = out + State::by_x;
    double* eta_rate = out + State::by_eta;
    for (std::size_t j = 0; j < 6; ++j) {
      const double e0 = eta[j], e1 = eta[6 + j], e2 = eta[12 + j];
      const double x0 = dx[j], x1 = dx[6 + j], x2 = dx[12 + j];
      const double t0 = e1 * t[2] - e2 * t[1], t1 = e2 * t[0] - e0 * t[2], t2 = e0 * t[1] - e1 * t[0];
      const double change = p[0] * t0 + p[1] * t1 + p[2] * t2;
      dx_rate[j] = horizontal * (change * t[0] + along * t0);
      dx_rate[6 + j] = horizontal * (change * t[1] + along * t1);
      dx_rate[12 + j] = horizontal * (change * t[2] + along * t2);
      eta_rate[j] = x2 * p[1] - x1 * p[2] + angular[1] * e2 - angular[2] * e1;
      eta_rate[6 + j] = x0 * p[2] - x2 * p[0] + angular[2] * e0 - angular[0] * e2;
      eta_rate[12 + j] = x1 * p[0] - x0 * p[1] + angular[0] * e1 - angular[1] * e0;
    }
    // What δm₀ and δp₀ add: δm₀ to η', −x × δp₀ to η', κ δp₀ + (1 − κ)(δp₀·t) t to δx'.
    for (std::size_t k = 0; k < 3; ++k) {
      const int axis = static_cast<int>(k);
      eta_rate[6 * k + k] += 1.0;
      const Vector3 lever = cross(x, Vector3::unit(axis));
      for (std::size_t i = 0; i < 3; ++i) {
        eta_rate[6 * i + 3 + k] -= lever[static_cast<int>(i)];
        dx_rate[6 * i + 3 + k] += horizontal * t[axis] * t[static_cast<int>(i)];
      }
      dx_rate[6 * k + 3 + k] += compliance;
    }
  }
};

constexpr int stages = 12;

/// Lower triangle of the method's coefficients, and its weights.
constexpr std::array<std::array<double, stages>, stages + 1> coefficients{{
    {},
    {0.05260015195876773},
    {0.0197250569845379, 0.0591751709536137},
    {0.02958758547680685, 0.0, 0.08876275643042054},
    {0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792},
    {0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242},
    {0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125},
    {0.03709200011850479, 0.0, 0.0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
     0.008273789163814023},
    {0.6241109587160757, 0.0, 0.0, -3.3608926294469414, -0.868219346841726, 27.59209969944671, 20.154067550477894,
     -43.48988418106996},
    {0.47766253643826434, 0.0, 0.0, -2.4881146199716677, -0.590290826836843, 21.230051448181193, 15.279233632882423,
     -33.28821096898486, -0.020331201708508627},
    {-0.9371424300859873, 0.0, 0.0, 5.186372428844064, 1.0914373489967295, -8.149787010746927, -18.52006565999696,
     22.739487099350505, 2.4936055526796523, -3.0467644718982196},
    {2.273310147516538, 0.0, 0.0, -10.53449546673725, -2.0008720582248625, -17.9589318631188, 27.94888452941996,
     -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636},
    {0.054293734116568765, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003, -5.801203960010585,
     0.3111643669578199, -0.1521609496625161, 0.20136540080403034, 0.04471061572777259},
}};

void step(const Equations& equations, double length, State& state) noexcept {
  std::array<State, stages> rate;
  equations(state, rate[0]);
  for (std::size_t stage = 1; stage <= stages; ++stage) {
    State next = state;
    for (std::size_t k = 0; k < stage; ++k) {
      const double weight = length * coefficients[stage][k];
      if (weight == 0.0) continue;
      for (std::size_t i = 0; i < State::size; ++i) next.data[i] += weight * rate[k].data[i];
    }
    if (stage == stages) {
      state = next;
    } else {
      equations(next, rate[stage]);
    }
  }
}

}  // namespace

double squared_length(const Covector& start, const Weights& weights) noexcept {
  const Vector3 m = moment(start), p = force(start);
  return m[0] * m[0] / weights.roll_squared + m[1] * m[1] + m[2] * m[2] + p[0] * p[0] +
         weights.lateral_compliance * (p[1] * p[1] + p[2] * p[2]);
}

GeodesicEnd follow_geodesic(const Covector& start, double duration, const Weights& weights,
                            Accuracy accuracy) noexcept {
  const Equations equations{moment(start), force(start), weights.lateral_compliance};
  const double rate =
      std::max(norm(equations.m), norm(equations.p) * std::max(1.0, std::fabs(1.0 - equations.compliance)));
  const double longest = accuracy == Accuracy::fine ? 0.15 : 0.8;
  const int steps = std::clamp(static_cast<int>(std::ceil(rate * duration / longest)), 1, 2000);
  State state;
  state.data[State::q] = 1.0;
  for (int i = 0; i < steps; ++i) step(equations, duration / steps, state);

  const double* s = state.data.data();
  const double roll_rate = 1.0 / weights.roll_squared - 1.0;
  const lie::Rotation roll = lie::about_first_axis(equations.m[0] * roll_rate * duration);
  GeodesicEnd end;
  end.pose.rotation = lie::Rotation::load(s + State::q).normalized() * roll;
  end.pose.position = Vector3::load(s + State::x);
  const Matrix3 to_body = end.pose.rotation.matrix().transpose();
  for (int j = 0; j < 6; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const Vector3 turn =
        to_body * Vector3{{s[State::by_eta + at], s[State::by_eta + 6 + at], s[State::by_eta + 12 + at]}};
    const Vector3 move = to_body * Vector3{{s[State::by_x + at], s[State::by_x + 6 + at], s[State::by_x + 12 + at]}};
    end.by_start.set_column(j, lie::se3::twist(turn, move));
  }
  end.by_start(0, 0) += roll_rate * duration;
  end.covector =
      lie::se3::twist(to_body * (equations.m - cross(end.pose.position, equations.p)), to_body * equations.p);
  return end;
}

Matrix<6, 6> covector_by_start(const GeodesicEnd& end) noexcept {
  const Matrix3 to_body = end.pose.rotation.matrix().transpose();
  const Vector3 m = moment(end.covector), p = force(end.covector);
  Matrix<6, 6> out;
  for (int j = 0; j < 6; ++j) {
    const Vector3 axis = Vector3::unit(j % 3);
    const lie::se3::Twist motion = end.by_start.column(j);
    const Vector3 turn = lie::se3::angular(motion), move = lie::se3::linear(motion);
    const Vector3 direct_m = j < 3 ? axis : -cross(end.pose.position, axis);
    const Vector3 direct_p = j < 3 ? Vector3() : axis;
    out.set_column(
        j, lie::se3::twist(to_body * direct_m - cross(move, p) + cross(m, turn), to_body * direct_p + cross(p, turn)));
  }
  return out;
}

}  // namespace bowstring::geodesics
