// The values that a metric looks at, with what is known of their noise. Behind metrics.cpp.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "experiments/judging/metrics.h"

namespace airlight::experiments {

struct MetricName {
  std::string base;
  bool foreground = false;
  int channel = -1;  // all
};

// Batch means stand for the batches; with exact images there are none, and every function sees one difference without
// noise. Value i is one channel of one pixel; the channels of a pixel follow one another.
class Values {
 public:
  // Throws Error as `measure` does.
  Values(const scene::Film& image, const scene::Film& reference, const std::string& layer, const MetricName&,
         const Masks&, ImageNoise);

  std::size_t size() const { return index_.size(); }
  std::size_t pixel(std::size_t i) const { return index_[i] / 3; }
  int batch_count() const { return int(std::max(a_batches_.size(), r_batches_.size())); }
  bool noisy() const { return batch_count() > 0 || only_errors(); }
  // The image's own noise is part of its error.
  bool counted() const { return counted_; }
  bool reference_is_noisy() const { return !r_batches_.empty(); }
  bool image_has_batches() const { return !a_batches_.empty(); }
  // The image has no batches but standard errors.
  bool only_errors() const { return !se_.empty(); }

  double a(std::size_t i) const { return a_[index_[i]]; }
  double r(std::size_t i) const { return r_[index_[i]]; }
  double d(std::size_t i) const { return a(i) - r(i); }
  double a(std::size_t i, int b) const { return a_batches_.empty() ? a(i) : a_batches_[std::size_t(b)][index_[i]]; }
  double r(std::size_t i, int b) const { return r_batches_.empty() ? r(i) : r_batches_[std::size_t(b)][index_[i]]; }
  double d(std::size_t i, int b) const { return a(i, b) - r(i, b); }
  double se(std::size_t i) const { return se_[index_[i]]; }
  double samples(std::size_t i) const;  // behind that; infinite if not known
  // Noise that the batches of either film cannot show (batches.h).
  bool has_unresolved() const { return !a_unresolved_.empty() || !r_unresolved_.empty(); }
  double unresolved(std::size_t i) const;
  std::size_t channel(std::size_t i) const { return index_[i] % 3; }

  // Greatest less least value of the reference, smoothed over the kept pixels among 3x3.
  double smoothed_range() const;

 private:
  std::span<const float> a_, r_, se_, n_;
  std::vector<std::span<const float>> a_batches_, r_batches_;
  std::vector<float> a_unresolved_, r_unresolved_;
  int width_, height_;
  bool counted_ = false;
  std::vector<unsigned char> kept_;
  std::vector<std::size_t> index_;
};

// Over the batches [begin, end) without one: mean, mean over pairs of different batches, variance of one batch.
class Group {
 public:
  Group(int begin, int end, int without)
      : begin_(begin), end_(end), without_(without), n_(end - begin - (without >= begin && without < end)) {}
  double size() const { return n_; }
  template <class F>
  double mean(F value) const {
    return sums(value).sum / n_;
  }
  template <class F>
  double pair_mean(F value) const {
    const Sums s = sums(value);
    return (s.sum * s.sum - s.squares) / (n_ * (n_ - 1));
  }
  template <class F>
  double variance(F value) const {
    const double center = mean(value);
    return sums([&](int b) { return value(b) - center; }).squares / (n_ - 1);
  }

 private:
  struct Sums {
    double sum = 0, squares = 0;
  };
  template <class F>
  Sums sums(F value) const {
    Sums s;
    for (int b = begin_; b < end_; ++b)
      if (b != without_) {
        const double v = value(b);
        s.sum += v;
        s.squares += v * v;
      }
    return s;
  }
  int begin_, end_, without_;
  double n_;
};

}  // namespace airlight::experiments
