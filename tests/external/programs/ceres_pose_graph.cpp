// A stand-alone pose-graph optimiser that shares no code with loopbench:
//   ceres_pose_graph PROBLEM RESULT
// reads PROBLEM/graph.g2o, minimises the squared twist errors Log(Z^-1 X_i^-1 X_j), and writes g2o
// vertices and RESULT.json. See methods/bring_a_method.md for the exchange.
#include <ceres/ceres.h>

#include <Eigen/Geometry>
#include <chrono>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Information = Eigen::Matrix<double, 6, 6>;  // of the twist [rho; phi]

struct Vertex {
  Eigen::Vector3d position;
  Eigen::Quaterniond rotation;
};

struct Measured {
  std::size_t from = 0;
  std::size_t to = 0;
  Vertex pose;
  Information information;
};

struct Graph {
  std::vector<Vertex> vertices;
  std::vector<Measured> edges;
  bool planar = false;
};

Vertex planar_pose(double x, double y, double yaw) {
  return {{x, y, 0.0}, Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))};
}

Vertex read_pose(std::istream& in) {
  Vertex out;
  in >> out.position.x() >> out.position.y() >> out.position.z();
  in >> out.rotation.x() >> out.rotation.y() >> out.rotation.z() >> out.rotation.w();
  out.rotation.normalize();
  return out;
}

/// Upper triangle, row by row.
Eigen::MatrixXd read_symmetric(std::istream& in, int size) {
  Eigen::MatrixXd out(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = i; j < size; ++j) {
      in >> out(i, j);
      out(j, i) = out(i, j);
    }
  }
  return out;
}

Information planar_information(std::istream& in) {
  const Eigen::MatrixXd plane = read_symmetric(in, 3);
  Information out = Information::Zero();
  out(2, 2) = (plane(0, 0) + plane(1, 1)) / 2.0;  // keeps the graph in the plane
  out(3, 3) = out(4, 4) = plane(2, 2);
  const int at[] = {0, 1, 5};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out(at[i], at[j]) = plane(i, j);
  }
  return out;
}

/// g2o states it for the vector part of the quaternion, half of the rotation vector.
Information spatial_information(std::istream& in) {
  Information scale = Information::Identity();
  scale.diagonal().tail<3>().setConstant(0.5);
  return scale * read_symmetric(in, 6) * scale;
}

Graph read_graph(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + ": cannot be read");
  Graph out;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    std::size_t id = 0;
    double x = 0.0;
    double y = 0.0;
    double yaw = 0.0;
    Measured edge;
    words >> kind;
    if (kind == "VERTEX_SE2") {
      words >> id >> x >> y >> yaw;
      out.vertices.push_back(planar_pose(x, y, yaw));
      out.planar = true;
    } else if (kind == "VERTEX_SE3:QUAT") {
      words >> id;
      out.vertices.push_back(read_pose(words));
    } else if (kind == "EDGE_SE2") {
      words >> edge.from >> edge.to >> x >> y >> yaw;
      edge.pose = planar_pose(x, y, yaw);
      edge.information = planar_information(words);
      out.edges.push_back(edge);
    } else if (kind == "EDGE_SE3:QUAT") {
      words >> edge.from >> edge.to;
      edge.pose = read_pose(words);
      edge.information = spatial_information(words);
      out.edges.push_back(edge);
    } else if (kind != "FIX") {
      throw std::runtime_error(kind + ": not supported");
    }
    if (!words) throw std::runtime_error("cannot parse: " + line);
  }
  return out;
}

/// Whitened Log(Z^-1 X_i^-1 X_j).
struct TwistError {
  Vertex measured;
  Information root;  // upper triangular, root' root = information

  template <class T>
  bool operator()(const T* p_i, const T* q_i, const T* p_j, const T* q_j, T* residual) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    using Rotation = Eigen::Quaternion<T>;
    const Eigen::Map<const Rotation> rotation_i(q_i);
    const Eigen::Map<const Rotation> rotation_j(q_j);
    const Vector between = Eigen::Map<const Vector>(p_j) - Eigen::Map<const Vector>(p_i);
    const Rotation back = measured.rotation.conjugate().cast<T>();
    const Vector t = back * (rotation_i.conjugate() * between - measured.position.cast<T>());
    Rotation r = back * (rotation_i.conjugate() * rotation_j);
    if (r.w() < T(0)) r.coeffs() = -r.coeffs();
    const T sine2 = r.vec().squaredNorm();
    T factor = T(2);          // of phi = factor * vec
    T second = T(1) / T(12);  // of rho = t - phi x t / 2 + second * phi x (phi x t)
    if (sine2 > T(1e-10)) {
      const T sine = sqrt(sine2);
      const T angle = T(2) * atan2(sine, r.w());
      factor = angle / sine;
      second = T(1) / (angle * angle) - r.w() / (T(2) * angle * sine);
    }
    const Vector phi = factor * r.vec();
    Eigen::Matrix<T, 6, 1> error;
    error << t - phi.cross(t) / T(2) + second * phi.cross(phi.cross(t)), phi;
    Eigen::Map<Eigen::Matrix<T, 6, 1>> out(residual);
    out = root.cast<T>() * error;
    return true;
  }
};

ceres::Solver::Summary optimise(Graph& graph) {
  ceres::Problem problem;
  auto* manifold = new ceres::EigenQuaternionManifold;
  for (const Measured& edge : graph.edges) {
    Vertex& i = graph.vertices.at(edge.from);
    Vertex& j = graph.vertices.at(edge.to);
    const Information root = edge.information.llt().matrixU();
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<TwistError, 6, 3, 4, 3, 4>(new TwistError{edge.pose, root}),
        nullptr,
        i.position.data(),
        i.rotation.coeffs().data(),
        j.position.data(),
        j.rotation.coeffs().data());
    problem.SetManifold(i.rotation.coeffs().data(), manifold);
    problem.SetManifold(j.rotation.coeffs().data(), manifold);
  }
  problem.SetParameterBlockConstant(graph.vertices.front().position.data());
  problem.SetParameterBlockConstant(graph.vertices.front().rotation.coeffs().data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

void write_result(const Graph& graph, const std::string& file) {
  std::ofstream out(file);
  out << std::setprecision(17);
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
    const auto& [p, q] = graph.vertices[i];
    if (graph.planar) {
      out << "VERTEX_SE2 " << i << ' ' << p.x() << ' ' << p.y() << ' '
          << 2.0 * std::atan2(q.z(), q.w()) << '\n';
    } else {
      out << "VERTEX_SE3:QUAT " << i << ' ' << p.transpose() << ' ' << q.coeffs().transpose()
          << '\n';
    }
  }
  if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) throw std::runtime_error("usage: ceres_pose_graph PROBLEM RESULT");
  Graph graph = read_graph(std::string(argv[1]) + "/graph.g2o");
  const auto begin = std::chrono::steady_clock::now();
  const ceres::Solver::Summary summary = optimise(graph);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  write_result(graph, argv[2]);
  std::ofstream(std::string(argv[2]) + ".json")
      << std::setprecision(17) << "{\"seconds\": " << seconds.count()
      << ", \"iterations\": " << summary.iterations.size()
      << ", \"counts\": {\"chi2\": " << 2.0 * summary.final_cost << "}}\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
