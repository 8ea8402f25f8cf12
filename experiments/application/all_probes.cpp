// The list of probes, for programs that measure what is no picture.
#include "experiments/application/probes.h"
#include "experiments/compensated_ray_marching/fitted_picture_probe.h"
#include "experiments/compensated_ray_marching/gaussian_fit_probe.h"
#include "experiments/compensated_ray_marching/residual_decode_probe.h"
#include "experiments/compensated_ray_marching/residual_probe.h"
#include "experiments/legendre_fluids/fluid_probes.h"
#include "experiments/legendre_fluids/frame_probe.h"
#include "experiments/legendre_fluids/rendering_probe.h"
#include "experiments/shadow_planes/evaluator_probes.h"
#include "experiments/stable_fluids/probes.h"
#include "experiments/verify/oracle_probe.h"
#include "experiments/wavelet_fog/column_probe.h"
#include "experiments/wavelet_fog/errata_probe.h"
#include "experiments/wavelet_fog/seam_probe.h"
#include "experiments/wavelet_fog/size_probe.h"

namespace airlight::experiments {

const std::vector<std::unique_ptr<Probe>>& all_probes() {
  static const auto probes = [] {
    std::vector<std::unique_ptr<Probe>> list;
    list.push_back(std::make_unique<OracleProbe>());
    list.push_back(std::make_unique<shadow_planes::EvaluatorMap>());
    list.push_back(std::make_unique<shadow_planes::EvaluatorAngles>());
    list.push_back(std::make_unique<shadow_planes::EvaluatorImage>());
    list.push_back(std::make_unique<shadow_planes::EvaluatorTimes>());
    list.push_back(std::make_unique<shadow_planes::EvaluatorTimesGpu>());
    list.push_back(std::make_unique<ColumnFogmaps>());
    list.push_back(std::make_unique<WaveletSeams>());
    list.push_back(std::make_unique<WaveletErrata>());
    list.push_back(std::make_unique<WaveletMapSize>());
    list.push_back(std::make_unique<LegendreRendering>());
    list.push_back(std::make_unique<CavityProbe>());
    list.push_back(std::make_unique<FlowStability>());
    list.push_back(std::make_unique<PressureSolvers>());
    list.push_back(std::make_unique<LegendreCost>());
    list.push_back(std::make_unique<LegendreSpeed>());
    list.push_back(std::make_unique<LegendreStability>());
    list.push_back(std::make_unique<LegendreSmoke>());
    list.push_back(std::make_unique<LegendreFrame>());
    list.push_back(std::make_unique<LegendreFrameGpu>());
    list.push_back(std::make_unique<ResidualStores>());
    list.push_back(std::make_unique<ResidualDecode>());
    list.push_back(std::make_unique<GaussianFitProbe>());
    list.push_back(std::make_unique<FittedPicture>());
    return list;
  }();
  return probes;
}

}  // namespace airlight::experiments
