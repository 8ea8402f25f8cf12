#include "gpu/shadow_planes/rule_on_device.h"

#include "gpu/program.h"
#include "methods/shadow_planes/mapped_rule.h"

namespace airlight::gpu {

std::vector<float> rule_nodes(int nodes, int m, bool root_ends) {
  const shadow_planes::MappedRule<double> rule(nodes, m, root_ends);
  std::vector<float> values;
  for (std::size_t i = 0; i < rule.node.size(); ++i)
    values.insert(values.end(), {float(rule.node[i]), float(1 - rule.node[i]), float(rule.weight[i]), 0});
  return values;
}

std::vector<float> rule_integrals(Context& context, const shadow_planes::PhaseForm& phase, int nodes, int m,
                                  const std::vector<RuleCase>& cases) {
  const Use use(context);
  const Buffer rule(context, "rule", rule_nodes(nodes, m, false)), input(context, "cases", cases);
  const Buffer output(context, "integrals", cases.size() * 4);
  rule.bind(5);
  input.bind(0);
  output.bind(1);
  Program& p = context.program("shadow_planes/evaluate.comp", {{"LOCAL_SIZE_X", "64"}, {"POWER", std::to_string(m)}});
  p.set("case_count", int(cases.size()));
  p.set("rule_nodes", nodes);
  p.set("phase_kind", int(phase.kind));
  p.set("phase_g", phase.g);
  p.set("phase_scale", phase.scale);
  p.set("phase_width", phase.width());
  p.dispatch(int(cases.size()));
  std::vector<float> values = output.download<float>();
  values.resize(cases.size());
  return values;
}

}  // namespace airlight::gpu
