#include "reference/ray_marcher/tile.h"

#include <algorithm>
#include <cmath>

#include "reference/ray_marcher/depth.h"
#include "reference/ray_marcher/samples.h"
#include "reference/ray_marcher/shapes.h"
#include "scene/light/background.h"

namespace airlight::ray_marcher {

const std::vector<Pixel>& TileMarcher::march(const Plan& plan, const std::vector<Ray>& rays, Counters& counters) {
  plan_ = &plan;
  rays_ = &rays;
  counters_ = &counters;
  channels_ = 1;
  for (const Layer& layer : plan.layers)
    if (!(layer.medium->sigma_t == layer.medium->sigma_t[0]).all()) channels_ = 3;
  pixels_.assign(rays.size(), Pixel());
  since_ = std::chrono::steady_clock::now();
  lay_steps();
  divide_deep_steps();
  place_steps();
  end_of(&Counters::ray_seconds);
  sample_densities();
  weigh_steps();
  end_of(&Counters::march_seconds);
  for (int light = 0; plan.scatters && light < int(plan.lights.size()); ++light) scatter_light(light);
  collect();
  end_of(&Counters::scattering_seconds);
  shade_behind();
  end_of(&Counters::surface_seconds);
  return pixels_;
}

std::vector<Pixel> TileMarcher::march_in_parts(const Plan& plan, const std::vector<Ray>& rays, std::size_t at_once,
                                               Counters& counters) {
  if (rays.size() <= at_once) return march(plan, rays, counters);
  std::vector<Pixel> pixels;
  for (std::size_t begin = 0; begin < rays.size(); begin += at_once) {
    const std::vector<Ray> part(rays.begin() + begin, rays.begin() + std::min(begin + at_once, rays.size()));
    march(plan, part, counters);
    pixels.insert(pixels.end(), pixels_.begin(), pixels_.end());
  }
  return pixels;
}

// Books the time since the last stage ended.
void TileMarcher::end_of(double Counters::*stage) {
  const auto now = std::chrono::steady_clock::now();
  counters_->*stage += std::chrono::duration<double>(now - since_).count();
  since_ = now;
}

void TileMarcher::lay_steps() {
  counters_->rays += rays_->size();
  ends_.clear();
  passes_.clear();
  plain_steps_.clear();
  for (int r = 0; r < int(rays_->size()); ++r) {
    ends_.push_back(camera_end(*plan_->scene, (*rays_)[r]));
    add_passes(*plan_, r, (*rays_)[r], ends_.back().t, passes_, plain_steps_);
  }
}

// Where a ray may be too thick for its steps, and is: by kernels at the ends and middles of all such steps, before any
// of them is divided one by one.
void TileMarcher::divide_deep_steps() {
  index_.clear();
  for (int i = 0; i < int(plain_steps_.size()); ++i)
    if (may_be_deep(plan_->layers, plan_->options, plain_steps_[i])) index_.push_back(i);
  if (index_.empty()) return;
  std::vector<int> ray_of(plain_steps_.size());
  for (const Pass& pass : passes_)
    std::fill(ray_of.begin() + pass.spacing.begin, ray_of.begin() + pass.spacing.end, pass.ray);
  const std::size_t n = index_.size();
  std::vector<Rgb> greatest(n, Rgb::Zero());
  Points at;
  at.resize(n);
  for (const double place : {-0.5, 0.0, 0.5}) {
    std::vector<Rgb> here(n, Rgb::Zero());
    for (std::size_t i = 0; i < n; ++i) {
      const Step& step = plain_steps_[index_[i]];
      at.set(i, (*rays_)[ray_of[index_[i]]].at(step.t + place * step.length));
    }
    for (std::size_t k = 0; k < plan_->layers.size(); ++k) {
      const Layer& layer = plan_->layers[k];
      kept_.clear();
      for (std::size_t i = 0; i < n; ++i) {
        const unsigned long long inside = plain_steps_[index_[i]].inside;
        if (in_constant(inside, k)) here[i] += layer.constant * layer.medium->sigma_t;
        if (in_varied(inside, k)) kept_.push_back(int(i));
      }
      if (kept_.empty()) continue;
      points_.select(at, kept_);
      varied_densities(layer, points_, kept_.size());
      for (std::size_t i = 0; i < kept_.size(); ++i) here[kept_[i]] += double(value_[i]) * layer.medium->sigma_t;
    }
    for (std::size_t i = 0; i < n; ++i) greatest[i] = greatest[i].max(here[i]);
  }
  std::vector<char> deep(rays_->size(), 0);
  for (std::size_t i = 0; i < n; ++i)
    if (is_deep(plan_->options, infinity, Rgb::Zero(), greatest[i], plain_steps_[index_[i]].length, true))
      deep[ray_of[index_[i]]] = 1;
  if (std::none_of(deep.begin(), deep.end(), [](char d) { return d; })) return;
  divided_.clear();
  for (Pass& pass : passes_) {
    const Step *begin = plain_steps_.data() + pass.spacing.begin, *end = plain_steps_.data() + pass.spacing.end;
    pass.spacing.begin = divided_.size();
    if (deep[pass.ray])
      follow_depth(*plan_, (*rays_)[pass.ray], pass.spacing.deepest, begin, end, divided_);
    else
      divided_.insert(divided_.end(), begin, end);
    pass.spacing.end = divided_.size();
  }
  plain_steps_.swap(divided_);
}

void TileMarcher::place_steps() {
  count_ = plain_steps_.size();
  all_.resize(count_);
  for (const Pass& pass : passes_) {
    const Ray& ray = (*rays_)[pass.ray];
    for (std::size_t i = pass.spacing.begin; i < pass.spacing.end; ++i) {
      all_.at.set(i, ray.at(plain_steps_[i].t));
      all_.direction.set(i, ray.direction);
      all_.length[i] = float(plain_steps_[i].length);
    }
  }
}

void TileMarcher::sample_densities() {
  density_.resize(plan_->layers.size());
  for (std::size_t k = 0; k < plan_->layers.size(); ++k) {
    const Layer& layer = plan_->layers[k];
    std::vector<float>& density = density_[k];
    density.assign(padded(count_), 0.0f);
    index_.clear();
    for (std::size_t i = 0; i < count_; ++i) {
      if (layer.constant > 0 && in_constant(plain_steps_[i].inside, k)) density[i] = float(layer.constant);
      if (in_varied(plain_steps_[i].inside, k)) index_.push_back(int(i));
    }
    if (index_.empty()) continue;
    const std::size_t n = index_.size();
    if (n < count_) points_.select(all_.at, index_);
    const Points& points = n < count_ ? points_ : all_.at;
    varied_densities(layer, points, n);
    for (std::size_t i = 0; i < n; ++i) density[index_[i]] += value_[i];
    counters_->steps += n;
  }
}

// Into value_.
void TileMarcher::varied_densities(const Layer& layer, const Points& points, std::size_t n) {
  for (auto* v : {&local_[0], &local_[1], &local_[2], &value_}) resize_padded(*v, n);
  float *x = local_[0].data(), *y = local_[1].data(), *z = local_[2].data();
  if (layer.grid || layer.gaussians)
    to_local(layer.grid ? layer.grid->frame : layer.gaussians->frame, n, points.x.data(), points.y.data(),
             points.z.data(), x, y, z);
  if (layer.grid)
    grid_density(*layer.grid, n, x, y, z, value_.data());
  else if (layer.gaussians)
    gaussian_density(*layer.gaussians, n, x, y, z, value_.data());
  else
    for (std::size_t i = 0; i < n; ++i) value_[i] = float(varied_density(layer, points.at(i)));
}

// Optical depths in front of the steps, in double; the weights of the steps; and what is left of them that scatters.
void TileMarcher::weigh_steps() {
  for (int c = 0; c < channels_; ++c) resize_padded(before_[c], count_), resize_padded(depth_[c], count_);
  const double darkest = plan_->options.early_exit > 0 ? -std::log(plan_->options.early_exit) : infinity;
  for (Pass& pass : passes_) {
    Rgb total = Rgb::Zero();
    bool ended = false;
    for (std::size_t i = pass.spacing.begin; i < pass.spacing.end; ++i) {
      ended = (total.head(channels_) > darkest).all();
      if (ended) {
        pass.spacing.end = i;
        break;
      }
      for (int c = 0; c < channels_; ++c) {
        double extinction = 0;
        for (std::size_t k = 0; k < plan_->layers.size(); ++k)
          extinction += plan_->layers[k].medium->sigma_t[c] * density_[k][i];
        before_[c][i] = float(total[c]);
        depth_[c][i] = float(extinction * all_.length[i]);
        total[c] += extinction * all_.length[i];
      }
    }
    if (pass.own_light < 0)
      for (int c = 0; c < 3; ++c)
        pixels_[pass.ray].transmittance[c] =
            pass.spacing.endless[c] || ended ? 0 : std::exp(-total[channels_ == 1 ? 0 : c]);
  }
  if (!plan_->scatters) return;
  all_.amount.resize(plan_->layers.size() * channels_);
  resize_padded(weight_, count_);
  for (int c = 0; c < channels_; ++c) {
    step_weights(count_, before_[c].data(), depth_[c].data(), all_.length.data(), weight_.data());
    for (std::size_t k = 0; k < plan_->layers.size(); ++k) {
      std::vector<float>& amount = all_.amount[slot(k, c)];
      resize_padded(amount, count_);
      const float sigma_t = float(plan_->layers[k].medium->sigma_t[c]);
      for (std::size_t i = 0; i < count_; ++i) amount[i] = weight_[i] * sigma_t * density_[k][i];
    }
  }
  live_.clear();
  for (Pass& pass : passes_) {
    const std::size_t begin = live_.size();
    for (std::size_t i = pass.spacing.begin; i < pass.spacing.end; ++i)
      if (std::any_of(all_.amount.begin(), all_.amount.end(), [&](const auto& a) { return a[i] != 0; }))
        live_.push_back(int(i));
    pass.spacing.begin = begin;
    pass.spacing.end = live_.size();
  }
  steps_.select(all_, live_);
  count_ = live_.size();
  for (auto& s : sums_) s.assign(padded(count_), 0.0f);
}

void TileMarcher::scatter_light(int light) {
  index_.clear();
  for (std::size_t p = 0; p < passes_.size(); ++p)
    if (serves(passes_, p, light))
      for (std::size_t i = passes_[p].spacing.begin; i < passes_[p].spacing.end; ++i) index_.push_back(int(i));
  if (index_.empty()) return;
  const bool whole = index_.size() == count_;
  if (!whole) lit_.select(steps_, index_);
  to_.resize(index_.size());
  const LightShape shape = light_shape(plan_->lights[light]);
  const StepArrays* lit = whole ? &steps_ : &lit_;
  incidence(shape, index_.size(),
            {lit->at.x.data(), lit->at.y.data(), lit->at.z.data(), lit->direction.x.data(), lit->direction.y.data(),
             lit->direction.z.data(), lit->length.data()},
            to_.view());
  if (plan_->scene->geometry || shape.kind == LightShape::spot) {
    if (whole) lit_ = steps_;
    lit = &lit_;
    end_of(&Counters::scattering_seconds);
    keep_lit(light);
    end_of(&Counters::occlusion_seconds);
  }
  const std::size_t n = index_.size();
  if (n == 0) return;
  end_of(&Counters::scattering_seconds);
  columns_.march(*plan_, std::size_t(light), n, lit->at, to_, *counters_);
  end_of(&Counters::shadow_seconds);
  scatterers_.resize(plan_->layers.size());
  const Rgb colour = light_colour(plan_->lights[light]);
  for (std::size_t k = 0; k < scatterers_.size(); ++k) {
    const scene::Medium& medium = *plan_->layers[k].medium;
    Scatterer& s = scatterers_[k];
    s.phase = phase_shape(medium.phase);
    s.column = columns_.column(k).data();
    for (int c = 0; c < 3; ++c) {
      s.sigma_t[c] = float(medium.sigma_t[c]);
      s.colour[c] = float(medium.albedo[c] * colour[c]);
      s.amount[c] = lit->amount[slot(k, c < channels_ ? c : 0)].data();
    }
  }
  const bool direct = n == count_;
  if (!direct)
    for (auto& s : lit_sums_) s.assign(padded(n), 0.0f);
  auto* sums = direct ? sums_ : lit_sums_;
  float* const out[3] = {sums[0].data(), sums[1].data(), sums[2].data()};
  scatter(scatterers_.data(), scatterers_.size(), channels_, n, to_.view(), columns_.mapped(), out);
  for (int c = 0; !direct && c < 3; ++c)
    for (std::size_t i = 0; i < n; ++i) sums_[c][index_[i]] += lit_sums_[c][i];
}

// Leaves in lit_, to_ and index_ only what the light reaches: its cone, and not behind a surface.
void TileMarcher::keep_lit(int light) {
  const scene::Geometry* geometry = plan_->scene->geometry.get();
  kept_.clear();
  for (int i = 0; i < int(index_.size()); ++i) {
    if (to_.strength[i] == 0) continue;
    if (geometry) {
      const Point3 x = lit_.at.at(i);
      const scene::Incident from = incident(plan_->lights[light], x);
      ++counters_->occlusion_rays;
      if (geometry->occluded({x, from.to_light}, from.distance)) continue;
    }
    kept_.push_back(i);
  }
  if (kept_.size() == index_.size()) return;
  less_.select(lit_, kept_);
  std::swap(lit_, less_);
  fewer_.select(to_, kept_);
  std::swap(to_, fewer_);
  for (int& i : kept_) i = index_[i];
  index_.swap(kept_);
}

void TileMarcher::collect() {
  if (!plan_->scatters) return;
  for (const Pass& pass : passes_)
    for (int c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::size_t i = pass.spacing.begin; i < pass.spacing.end; ++i) sum += sums_[c][i];
      pixels_[pass.ray].airlight[c] += sum;
    }
}

void TileMarcher::shade_behind() {
  hit_.clear();
  for (int r = 0; r < int(rays_->size()); ++r) {
    if ((pixels_[r].transmittance == 0).all()) continue;
    if (ends_[r].hit)
      hit_.push_back(r);
    else
      pixels_[r].surface = pixels_[r].transmittance * background(*plan_->scene, ends_[r], (*rays_)[r].direction);
  }
  if (!hit_.empty()) light_surfaces();
}

// Direct light on the surfaces that the rays hit: brdf and occlusion point by point, columns all at once.
void TileMarcher::light_surfaces() {
  const scene::Geometry& geometry = *plan_->scene->geometry;
  points_.resize(hit_.size());
  to_.resize(hit_.size());
  for (std::size_t l = 0; l < plan_->lights.size(); ++l) {
    const scene::Light& light = plan_->lights[l];
    kept_.clear();
    reflected_.clear();
    for (const int r : hit_) {
      const scene::Hit& h = *ends_[r].hit;
      const scene::Incident from = incident(light, h.position);
      const double cosine = from.to_light.dot(h.normal);
      if (!(cosine > 0) || (from.irradiance == 0).all()) continue;
      const scene::Material& material = plan_->scene->surfaces[h.surface].material;
      const Rgb back = brdf(material, h.normal, from.to_light, -(*rays_)[r].direction) * cosine * from.irradiance;
      if ((back == 0).all()) continue;
      const Point3 origin = geometry.offset_origin(h.position, h.normal, from.to_light);
      ++counters_->occlusion_rays;
      if (geometry.occluded({origin, from.to_light}, from.distance)) continue;
      const std::size_t i = kept_.size();
      points_.set(i, origin);
      to_.to_x[i] = float(from.to_light[0]);
      to_.to_y[i] = float(from.to_light[1]);
      to_.to_z[i] = float(from.to_light[2]);
      to_.distance[i] = float(from.distance);
      kept_.push_back(r);
      reflected_.push_back(back);
    }
    if (kept_.empty()) continue;
    columns_.march(*plan_, l, kept_.size(), points_, to_, *counters_);
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      Rgb depth = Rgb::Zero();
      for (int c = 0; columns_.mapped() && c < 3; ++c) depth[c] = double(columns_.mapped()[c][i]);
      for (std::size_t k = 0; k < plan_->layers.size(); ++k)
        depth += plan_->layers[k].medium->sigma_t * double(columns_.column(k)[i]);
      pixels_[kept_[i]].surface += pixels_[kept_[i]].transmittance * reflected_[i] * (-depth).exp();
    }
  }
}

}  // namespace airlight::ray_marcher
