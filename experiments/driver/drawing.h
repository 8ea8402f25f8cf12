// What a plot shows, whatever draws it: curves of a run's rows, and axes that fit them.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/driver/outcome.h"

namespace airlight::experiments {

struct PlotPoint {
  Estimate x, y;
  bool bound = false;  // below the noise floor: only y.high is known
};

struct PlotCurve {
  std::string name;
  std::vector<PlotPoint> points;
};

struct Drawing {
  std::vector<PlotCurve> curves;
  double floor = 0;  // least noise of the reference; 0 where there is none
};

// The name of a method with the device that it ran on: a software renderer is no GPU.
std::string with_device(std::string method, const std::string& device);

bool is_column(const std::string& axis);

// The curves of a plot in a scene; `scene` is empty where one plot shows all scenes.
Drawing collect(const Outcome&, const PlotCase&, const std::string& scene);

// Blocks separated by two empty lines, as gnuplot counts them: per curve its values, then its upper bounds.
std::string data_csv(const Drawing&);

// The curves of a data file that data_csv wrote, without their intervals: a record holds no columns.
Drawing read_data(const std::filesystem::path& file);

// The label that the experiment gives, else the one of the quantity.
std::string axis_label(const std::string& given, const std::string& axis);

// The title of a plot: its own, else from the axes; with the scene, if any.
std::string plot_title(const PlotCase&, const std::string& scene);

// The scenes that have a plot of their own; one empty name where one plot shows all scenes.
std::vector<std::string> plot_scenes(const Outcome&, const PlotCase&);

// An axis that shows all its values. It is logarithmic where positive values span a factor of 4, or of 20 if there are
// values of 0, which then stand at its lower edge. With negative values it is linear.
class Axis {
 public:
  Axis(std::string name, std::vector<double> values, bool linear);
  std::string commands() const;
  // The gnuplot expression of a column of the data. What a logarithmic axis cannot show stands at its lower edge.
  std::string column(int number) const;
  bool logarithmic() const { return logarithmic_; }
  bool zeros_at_edge() const { return zeros_; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  std::string name_;
  bool logarithmic_ = false, zeros_ = false;
  double low_ = 0, high_ = 1;
};

// The axes of a drawing.
struct Axes {
  Axis x, y;
};
Axes axes_of(const Drawing&, const PlotCase&);

}  // namespace airlight::experiments
