#include "experiments/application/solvers.h"

#include "experiments/application/find_component.h"
#include "gpu/legendre_fluids/legendre_fluids.h"
#include "methods/legendre_fluids/legendre_fluids.h"
#include "reference/exact_flows/exact_flows.h"
#include "reference/stable_fluids/stable_fluids.h"

namespace airlight::experiments {

const std::vector<std::unique_ptr<scene::Solver>>& all_solvers() {
  static const auto solvers = [] {
    std::vector<std::unique_ptr<scene::Solver>> list;
    list.push_back(std::make_unique<legendre_fluids::LegendreFluids>());
    list.push_back(std::make_unique<gpu::legendre_fluids::LegendreFluids>());
    list.push_back(std::make_unique<stable_fluids::StableFluids>());
    list.push_back(std::make_unique<exact_flows::ExactFlows>());
    return list;
  }();
  return solvers;
}

const scene::Solver& find_solver(const std::string& name, const std::string& where) {
  return find_component(all_solvers(), "solver", name, where);
}

}  // namespace airlight::experiments
