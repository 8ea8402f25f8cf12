#include "gpu/shadow_planes/evaluator.h"

#include "gpu/shadow_planes/interface.h"
#include "gpu/timer.h"
#include "methods/shadow_planes/mapped_rule.h"
#include "methods/shadow_planes/polynomial.h"

namespace airlight::gpu::shadow_planes {

std::vector<float> rule_nodes(int nodes, int m, bool root_ends) {
  const airlight::shadow_planes::MappedRule<double> rule(nodes, m, root_ends);
  std::vector<float> values;
  for (std::size_t i = 0; i < rule.node.size(); ++i)
    values.insert(values.end(), {float(rule.node[i]), float(1 - rule.node[i]), float(rule.weight[i]), 0});
  return values;
}

std::vector<float> integrals_on_device(Context& context, const DeviceEvaluator& evaluator,
                                       const std::vector<EvaluatorCase>& cases, double* seconds) {
  const Use use(context);
  std::vector<float> numbers;
  if (evaluator.polynomial)
    for (const auto& row : airlight::shadow_planes::coefficients_in_a(evaluator.phase, evaluator.nodes))
      numbers.insert(numbers.end(), row.begin(), row.end());
  else
    numbers = rule_nodes(evaluator.nodes, evaluator.stretch, false);
  numbers.resize(4 * most_nodes);  // as many as the block has
  const Buffer table(context, "evaluator", numbers), input(context, "cases", cases);
  const Buffer output(context, "integrals", cases.size() * 4);
  table.bind_as(GL_UNIFORM_BUFFER, at::evaluator);
  input.bind(at::cases);
  output.bind(at::integrals);
  Program& p =
      program(context, "evaluate", 64, 1,
              {{"POLYNOMIAL", evaluator.polynomial ? "1" : "0"}, {"POWER", std::to_string(evaluator.stretch)}});
  p.set("case_count", int(cases.size()));
  if (evaluator.polynomial) {
    p.set("degree", evaluator.nodes);
  } else {
    p.set("rule_nodes", evaluator.nodes);
    p.set("phase_kind", int(evaluator.phase.kind));
    p.set("phase_g", evaluator.phase.g);
    p.set("phase_scale", evaluator.phase.scale);
    p.set("phase_width", evaluator.phase.width());
  }
  StageTimer timer(context);
  p.dispatch(int(cases.size()));
  timer.stage("evaluator");
  if (seconds) *seconds = timer.times().front().seconds;
  std::vector<float> values = output.download<float>();
  values.resize(cases.size());
  return values;
}

}  // namespace airlight::gpu::shadow_planes
