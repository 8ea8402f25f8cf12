#include "reference/ray_marcher/tile.h"

#include <algorithm>
#include <cmath>

#include "reference/ray_marcher/samples.h"

namespace airlight::ray_marcher {
namespace {

// A run of steps of one camera ray, and the lights that use it.
struct Pass {
  int ray;
  std::size_t begin, end;  // its steps; after compaction those that scatter
  std::vector<int> lights;
};

// Steps of a tile as arrays.
struct Steps {
  Points at, direction;  // midpoint; direction of the camera ray
  std::vector<float> length;
  // [layer][channel of the transport]: weight * sigma_t * density, what the step scatters per unit phase and irradiance
  std::vector<std::vector<float>> amount;

  void select(const Steps& from, const std::vector<int>& index) {
    at.select(from.at, index);
    direction.select(from.direction, index);
    gather(from.length, index, length);
    amount.resize(from.amount.size());
    for (std::size_t a = 0; a < amount.size(); ++a) gather(from.amount[a], index, amount[a]);
  }
};

PhaseShape phase_shape(const scene::PhaseFunction& phase) {
  PhaseShape shape;
  shape.kind = PhaseShape::Kind(phase.index());
  if (const auto* hg = std::get_if<scene::HenyeyGreenstein>(&phase)) shape.g = float(hg->g);
  return shape;
}

LightShape light_shape(const scene::Light& light) {
  LightShape shape;
  const auto put = [](const Vec3& v, double* to) { std::copy(v.data(), v.data() + 3, to); };
  if (const auto* sun = std::get_if<scene::DirectionalLight>(&light)) {
    put(sun->to_light, shape.axis);
  } else if (const auto* point = std::get_if<scene::PointLight>(&light)) {
    shape.kind = LightShape::point;
    put(point->position, shape.position);
  } else if (const auto* spot = std::get_if<scene::SpotLight>(&light)) {
    shape.kind = LightShape::spot;
    put(spot->position, shape.position);
    put(spot->axis, shape.axis);
    shape.cos_inner = std::cos(spot->inner_angle);
    shape.cos_outer = std::cos(spot->outer_angle);
  }
  return shape;
}

Rgb light_colour(const scene::Light& light) {
  if (const auto* sun = std::get_if<scene::DirectionalLight>(&light)) return sun->irradiance;
  if (const auto* point = std::get_if<scene::PointLight>(&light)) return point->intensity;
  return std::get<scene::SpotLight>(light).intensity;
}

// Everything about one tile; the functions are its stages, in order.
class Tile {
 public:
  Tile(const Plan& plan, const std::vector<Ray>& rays, Counters& counters)
      : plan_(plan), rays_(rays), counters_(counters), pixels_(rays.size()) {
    for (const Layer& layer : plan.layers)
      if (!(layer.medium->sigma_t == layer.medium->sigma_t[0]).all()) channels_ = 3;
  }

  std::vector<Pixel> run() {
    lay_steps();
    sample_densities();
    weigh_steps();
    for (int light = 0; light < int(plan_.lights.size()); ++light) scatter_light(light);
    collect();
    shade_behind();
    return std::move(pixels_);
  }

 private:
  void lay_steps();
  void sample_densities();
  void weigh_steps();
  void scatter_light(int light);
  void collect();
  void shade_behind();
  void light_surfaces(const std::vector<int>& hit);
  std::size_t slot(std::size_t layer, int channel) const { return layer * channels_ + channel; }

  const Plan& plan_;
  const std::vector<Ray>& rays_;
  Counters& counters_;
  std::vector<Pixel> pixels_;
  int channels_ = 1;  // of the transport: 1 where every extinction is grey
  std::vector<scene::RayEnd> ends_;
  std::vector<Pass> passes_;
  std::vector<unsigned long long> inside_;
  std::vector<std::vector<float>> density_;        // [layer][step]
  std::vector<Eigen::Array<bool, 3, 1>> endless_;  // per pass
  Steps steps_;
  std::size_t count_ = 0;  // steps
  std::vector<float> sums_[3];
};

void Tile::lay_steps() {
  counters_.rays += rays_.size();
  std::vector<RaySteps> all;
  for (int r = 0; r < int(rays_.size()); ++r) {
    ends_.push_back(ray_end(*plan_.scene, rays_[r]));
    all.push_back(ray_steps(plan_, rays_[r], ends_.back().t));
    for (RaySteps::Pass& pass : all.back().passes) {
      passes_.push_back({r, count_, count_ + pass.spacing.steps.size(), std::move(pass.lights)});
      endless_.push_back(pass.spacing.endless);
      count_ = passes_.back().end;
    }
  }
  steps_.at.resize(count_);
  steps_.direction.resize(count_);
  resize_padded(steps_.length, count_);
  inside_.resize(count_);
  std::size_t i = 0;
  for (std::size_t r = 0; r < rays_.size(); ++r)
    for (const RaySteps::Pass& pass : all[r].passes)
      for (const Step& step : pass.spacing.steps) {
        steps_.at.set(i, rays_[r].at(step.t));
        steps_.direction.set(i, rays_[r].direction);
        steps_.length[i] = float(step.length);
        inside_[i++] = step.inside;
      }
}

void Tile::sample_densities() {
  std::vector<float> lx, ly, lz, value;
  std::vector<int> index;
  Points points;
  density_.resize(plan_.layers.size());
  for (std::size_t k = 0; k < plan_.layers.size(); ++k) {
    const Layer& layer = plan_.layers[k];
    std::vector<float>& density = density_[k];
    density.assign(padded(count_), 0.0f);
    index.clear();
    for (std::size_t i = 0; i < count_; ++i) {
      if (layer.constant > 0 && in_constant(inside_[i], k)) density[i] = float(layer.constant);
      if (in_varied(inside_[i], k)) index.push_back(int(i));
    }
    if (index.empty()) continue;
    const std::size_t n = index.size();
    points.select(steps_.at, index);
    for (auto* v : {&lx, &ly, &lz, &value}) resize_padded(*v, n);
    if (layer.grid || layer.gaussians) {
      to_local(layer.grid ? layer.grid->frame : layer.gaussians->frame, n, points.x.data(), points.y.data(),
               points.z.data(), lx.data(), ly.data(), lz.data());
      if (layer.grid)
        grid_density(*layer.grid, n, lx.data(), ly.data(), lz.data(), value.data());
      else
        gaussian_density(*layer.gaussians, n, lx.data(), ly.data(), lz.data(), value.data());
    } else {
      for (std::size_t i = 0; i < n; ++i) value[i] = float(varied_density(layer, points.at(i)));
    }
    for (std::size_t i = 0; i < n; ++i) density[index[i]] += value[i];
    counters_.steps += n;
  }
}

// Optical depths in front of the steps, in double; the weights of the steps; and what is left of them that scatters.
void Tile::weigh_steps() {
  std::vector<float> before[3], depth[3], weight;
  for (int c = 0; c < channels_; ++c) resize_padded(before[c], count_), resize_padded(depth[c], count_);
  const double darkest = plan_.options.early_exit > 0 ? -std::log(plan_.options.early_exit) : infinity;
  for (std::size_t p = 0; p < passes_.size(); ++p) {
    Pass& pass = passes_[p];
    Rgb total = Rgb::Zero();
    bool ended = false;
    for (std::size_t i = pass.begin; i < pass.end; ++i) {
      ended = (total.head(channels_) > darkest).all();
      if (ended) {
        pass.end = i;
        break;
      }
      for (int c = 0; c < channels_; ++c) {
        double extinction = 0;
        for (std::size_t k = 0; k < plan_.layers.size(); ++k)
          extinction += plan_.layers[k].medium->sigma_t[c] * density_[k][i];
        before[c][i] = float(total[c]);
        depth[c][i] = float(extinction * steps_.length[i]);
        total[c] += extinction * steps_.length[i];
      }
    }
    // The first pass of a ray gives its transmittance.
    if (p > 0 && passes_[p - 1].ray == pass.ray) continue;
    for (int c = 0; c < 3; ++c)
      pixels_[pass.ray].transmittance[c] = endless_[p][c] || ended ? 0 : std::exp(-total[channels_ == 1 ? 0 : c]);
  }
  steps_.amount.resize(plan_.layers.size() * channels_);
  resize_padded(weight, count_);
  for (int c = 0; c < channels_; ++c) {
    step_weights(count_, before[c].data(), depth[c].data(), steps_.length.data(), weight.data());
    for (std::size_t k = 0; k < plan_.layers.size(); ++k) {
      std::vector<float>& amount = steps_.amount[slot(k, c)];
      resize_padded(amount, count_);
      const float sigma_t = float(plan_.layers[k].medium->sigma_t[c]);
      for (std::size_t i = 0; i < count_; ++i) amount[i] = weight[i] * sigma_t * density_[k][i];
    }
  }
  std::vector<int> live;
  for (Pass& pass : passes_) {
    const std::size_t begin = live.size();
    if (!pass.lights.empty())
      for (std::size_t i = pass.begin; i < pass.end; ++i)
        if (std::any_of(steps_.amount.begin(), steps_.amount.end(), [&](const auto& a) { return a[i] != 0; }))
          live.push_back(int(i));
    pass.begin = begin;
    pass.end = live.size();
  }
  Steps all;
  std::swap(all, steps_);
  steps_.select(all, live);
  count_ = live.size();
  for (auto& s : sums_) s.assign(padded(count_), 0.0f);
}

void Tile::scatter_light(int light) {
  std::vector<int> index;
  for (const Pass& pass : passes_)
    if (std::find(pass.lights.begin(), pass.lights.end(), light) != pass.lights.end())
      for (std::size_t i = pass.begin; i < pass.end; ++i) index.push_back(int(i));
  if (index.empty()) return;
  Steps lit;
  lit.select(steps_, index);
  Arrivals to;
  to.resize(index.size());
  const LightShape shape = light_shape(plan_.lights[light]);
  incidence(shape, index.size(),
            {lit.at.x.data(), lit.at.y.data(), lit.at.z.data(), lit.direction.x.data(), lit.direction.y.data(),
             lit.direction.z.data(), lit.length.data()},
            to.view());
  const scene::Geometry* geometry = plan_.scene->geometry.get();
  if (geometry || shape.kind == LightShape::spot) {
    // Only what the light reaches.
    std::vector<int> kept;
    for (int i = 0; i < int(index.size()); ++i) {
      if (to.strength[i] == 0) continue;
      if (geometry) {
        const scene::Incident from = incident(plan_.lights[light], lit.at.at(i));
        ++counters_.occlusion_rays;
        if (geometry->occluded({lit.at.at(i), from.to_light}, from.distance)) continue;
      }
      kept.push_back(i);
    }
    if (kept.empty()) return;
    Steps less;
    less.select(lit, kept);
    std::swap(lit, less);
    Arrivals fewer;
    fewer.select(to, kept);
    std::swap(to, fewer);
    for (int& i : kept) i = index[i];
    index.swap(kept);
  }
  const std::size_t n = index.size();
  Columns columns;
  columns.march(plan_, n, lit.at, to, counters_);
  std::vector<Scatterer> scatterers(plan_.layers.size());
  const Rgb colour = light_colour(plan_.lights[light]);
  for (std::size_t k = 0; k < scatterers.size(); ++k) {
    const scene::Medium& medium = *plan_.layers[k].medium;
    Scatterer& s = scatterers[k];
    s.phase = phase_shape(medium.phase);
    s.column = columns.column(k).data();
    for (int c = 0; c < 3; ++c) {
      s.sigma_t[c] = float(medium.sigma_t[c]);
      s.colour[c] = float(medium.albedo[c] * colour[c]);
      s.amount[c] = lit.amount[slot(k, c < channels_ ? c : 0)].data();
    }
  }
  std::vector<float> sums[3];
  for (auto& s : sums) s.assign(padded(n), 0.0f);
  float* const out[3] = {sums[0].data(), sums[1].data(), sums[2].data()};
  scatter(scatterers.data(), scatterers.size(), channels_, n, to.view(), out);
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < n; ++i) sums_[c][index[i]] += sums[c][i];
}

void Tile::collect() {
  for (const Pass& pass : passes_)
    for (int c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::size_t i = pass.begin; i < pass.end; ++i) sum += sums_[c][i];
      pixels_[pass.ray].airlight[c] += sum;
    }
}

void Tile::shade_behind() {
  std::vector<int> hit;
  for (int r = 0; r < int(rays_.size()); ++r) {
    if ((pixels_[r].transmittance == 0).all()) continue;
    if (ends_[r].hit)
      hit.push_back(r);
    else if (!ends_[r].on_ball)
      pixels_[r].surface = pixels_[r].transmittance * background(*plan_.scene, rays_[r].direction);
  }
  if (!hit.empty()) light_surfaces(hit);
}

// Direct light on the surfaces that the rays hit: brdf and occlusion point by point, columns all at once.
void Tile::light_surfaces(const std::vector<int>& hit) {
  const scene::Geometry& geometry = *plan_.scene->geometry;
  Points origins;
  Arrivals to;
  origins.resize(hit.size());
  to.resize(hit.size());
  std::vector<int> lit;
  std::vector<Rgb> reflected;
  Columns columns;
  for (const scene::Light& light : plan_.lights) {
    lit.clear();
    reflected.clear();
    for (const int r : hit) {
      const scene::Hit& h = *ends_[r].hit;
      const scene::Incident from = incident(light, h.position);
      const double cosine = from.to_light.dot(h.normal);
      if (!(cosine > 0) || (from.irradiance == 0).all()) continue;
      const scene::Material& material = plan_.scene->surfaces[h.surface].material;
      const Rgb back = brdf(material, h.normal, from.to_light, -rays_[r].direction) * cosine * from.irradiance;
      if ((back == 0).all()) continue;
      const Point3 origin = geometry.offset_origin(h.position, h.normal, from.to_light);
      ++counters_.occlusion_rays;
      if (geometry.occluded({origin, from.to_light}, from.distance)) continue;
      const std::size_t i = lit.size();
      origins.set(i, origin);
      to.to_x[i] = float(from.to_light[0]);
      to.to_y[i] = float(from.to_light[1]);
      to.to_z[i] = float(from.to_light[2]);
      to.distance[i] = float(from.distance);
      lit.push_back(r);
      reflected.push_back(back);
    }
    if (lit.empty()) continue;
    columns.march(plan_, lit.size(), origins, to, counters_);
    for (std::size_t i = 0; i < lit.size(); ++i) {
      Rgb depth = Rgb::Zero();
      for (std::size_t k = 0; k < plan_.layers.size(); ++k)
        depth += plan_.layers[k].medium->sigma_t * double(columns.column(k)[i]);
      pixels_[lit[i]].surface += pixels_[lit[i]].transmittance * reflected[i] * (-depth).exp();
    }
  }
}

}  // namespace

std::vector<Pixel> march_tile(const Plan& plan, const std::vector<Ray>& rays, Counters& counters) {
  return Tile(plan, rays, counters).run();
}

}  // namespace airlight::ray_marcher
