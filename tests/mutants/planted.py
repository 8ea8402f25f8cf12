"""The bugs, and the test that finds each."""
from typing import NamedTuple, Tuple


class Mutant(NamedTuple):
    name: str
    file: str
    changes: Tuple[Tuple[str, str], ...]  # text that is there once, and what becomes of it
    tests: str  # file below tests/
    test: str
    compiled: Tuple[str, ...] = ()  # sources that include a changed header; default: the file


SILHOUETTE = "methods/shadow_planes/silhouette.cpp", "methods/shadow_planes/silhouette_test.cpp"
COMPARISONS = "experiments/driver/comparisons.cpp", "experiments/comparisons_test.cpp"
RUN = "experiments/driver/images.cpp", "experiments/driver_noise_test.cpp"
PLAN = "experiments/driver/plan.cpp", "experiments/driver_noise_test.cpp"
PICTURES = "experiments/driver/pictures.cpp", "experiments/driver_noise_test.cpp"
METRICS = "experiments/judging/metrics.cpp", "experiments/hand_worked_metrics_test.cpp"
COUNTED = "experiments/judging/metrics.cpp", "experiments/counted_noise_test.cpp"
VALUES = "experiments/judging/metric_values.cpp", "experiments/hand_worked_metrics_test.cpp"
BATCHES = "experiments/judging/batches.cpp", "experiments/hand_worked_metrics_test.cpp"
EQUALITY = "experiments/judging/equality.cpp", "experiments/equality_test.cpp"
STATISTICS = "experiments/judging/statistics.cpp", "experiments/statistics_test.cpp"
FRONT = "experiments/judging/front.cpp", "experiments/statistics_test.cpp"
CHECK = "experiments/verify/check.cpp", "experiments/verify_tolerances_test.cpp"
DRAWN_AGAIN = "experiments/driver/bootstrap.cpp", "experiments/driver_bootstrap_test.cpp"
CONDITIONS = "experiments/driver/comparisons.cpp", "experiments/driver_bootstrap_test.cpp"
MARGINS = "experiments/driver/margins.cpp", "experiments/driver_margins_test.cpp"
TIMING = "experiments/driver/timing.cpp", "experiments/timing_test.cpp"
GATES = "experiments/driver/gates.cpp", "experiments/gates_test.cpp"
EXPOSURE = "experiments/driver/pictures.cpp", "experiments/pictures_test.cpp"
TIGHTEN = "scripts/tighten", "scripts/tighten_test.py"
FIGURES = "scripts/figures", "scripts/figures_test.py"
GALLERY = "scripts/gallery", "scripts/gallery_test.py"
SETUP = "scripts/setup", "scripts/options_test.py"
BUILD = "scripts/build", "scripts/options_test.py"
SMOKE_OPTIONS = "methods/compensated_ray_marching/options.cpp", "methods/compensated_ray_marching/stress_test.cpp"
SMOKE = "methods/compensated_ray_marching/marched_smoke.cpp", "methods/compensated_ray_marching/stress_test.cpp"
SMOKE_KEPT = "methods/compensated_ray_marching/marched_smoke.cpp", "methods/compensated_ray_marching/renderer_test.cpp"
CENTRES = "methods/compensated_ray_marching/centre_sources.cpp", "methods/compensated_ray_marching/renderer_test.cpp"
SMOKE_PICTURE = "methods/compensated_ray_marching/picture.cpp", "methods/compensated_ray_marching/stress_test.cpp"
VERIFY = "experiments/verify/verify.cpp", "experiments/verify_test.cpp"
CONFINED = "methods/legendre_fluids/confined_space.cpp", "methods/legendre_fluids/confined_space_test.cpp"
LEGENDRE_FLOW = "methods/legendre_fluids/legendre_flow.cpp", "methods/legendre_fluids/flow_test.cpp"
BOXES = "methods/legendre_fluids/confined_space.cpp", "methods/legendre_fluids/flow_test.cpp"
TIME_STEPS = "methods/legendre_fluids/time_steps.cpp", "methods/legendre_fluids/time_steps_test.cpp"
LEGENDRE_LINE = "scene/media/legendre_line.cpp", "scene/media/legendre_box_test.cpp"
LIGHT_RAYS = "methods/legendre_fluids/light_rays.cpp", "methods/legendre_fluids/light_rays_test.cpp"
LIGHT_PHASES = "methods/legendre_fluids/light_rays.cpp", "methods/legendre_fluids/light_pictures_test.cpp"
PAPER_VIEW = "methods/legendre_fluids/paper_view.cpp", "methods/legendre_fluids/paper_view_test.cpp"
PAPER_PICTURE = "methods/legendre_fluids/paper_picture.cpp", "methods/legendre_fluids/paper_view_test.cpp"
POLYGONS = "scene/geometry/polygon_cut.cpp", "scene/polygon_cut_test.cpp"
ATOMIC = "scene/base/atomic_file.cpp", "scene/atomic_file_test.cpp"
STORE = "scene/base/atomic_file.cpp", "scene/atomic_file_test.cpp"
ENTRIES = "scene/base/content_store.cpp", "scene/atomic_file_test.cpp"
SIMULATION = "experiments/application/simulation.cpp", "experiments/simulation_test.cpp"
WRITE_SCENE = "experiments/authoring/write_scene.cpp", "experiments/author_test.cpp"
TOML = "scene/load/parse_toml.cpp", "experiments/author_test.cpp"
INSTANCES = "scene/media/vdb_parts.cpp", "scene/media/vdb_io_test.cpp"
COLOURS = "scene/film/film_exr_read.cpp", "scene/film_test.cpp"
PARTICLES = "scene/flow/flow_particles.cpp", "scene/flow_particles_test.cpp"
CELLS = "reference/path_tracer/media.cpp", "reference/path_tracer/supergrid_test.cpp"
FORCES = "reference/stable_fluids/forces.cpp", "reference/stable_fluids/laws_test.cpp"
OBSTACLES = "reference/stable_fluids/obstacles.cpp", "reference/stable_fluids/laws_test.cpp"
GRID_FLOW = "reference/stable_fluids/grid_flow.cpp", "reference/stable_fluids/laws_test.cpp"
FLOW_TOTALS = "reference/stable_fluids/totals.cpp", "reference/stable_fluids/laws_test.cpp"
FLOW_DIFFUSION = "reference/stable_fluids/diffusion.cpp", "reference/stable_fluids/laws_test.cpp"
FLOW_METRICS = "experiments/judging/flow_metrics.cpp", "experiments/flows_test.cpp"
LEGENDRE_FILTER = "methods/legendre_fluids/confined_fluid.cpp", "methods/legendre_fluids/confined_space_test.cpp"
FIT = "scene/convert/gaussian_fit.cpp", "scene/convert/fitted_sequence_test.cpp"
PLACEMENT = "scene/convert/fit_placement.cpp", "scene/convert/gaussian_fit_test.cpp"
RESIDUAL = "scene/convert/residual.cpp", "scene/convert/residual_test.cpp"
PROJECTION = "scene/convert/legendre_projection.cpp", "scene/convert/legendre_projection_test.cpp"
PRODUCTS = "scene/math/sh_product.cpp", "experiments/verify_test.cpp"
ORDINATES = "methods/compensated_ray_marching/discrete_ordinates.cpp", "methods/compensated_ray_marching/discrete_ordinates_test.cpp"
ORDINATE_SWEEP = "methods/compensated_ray_marching/ordinate_sweep.cpp", "methods/compensated_ray_marching/discrete_ordinates_test.cpp"
WAVELETS = "methods/wavelet_fog/filters.cpp", "methods/wavelet_fog/decomposition_test.cpp"
LEVELS = "methods/wavelet_fog/levels.cpp", "methods/wavelet_fog/decomposition_test.cpp"
BLOCKS = "methods/wavelet_fog/blocks.cpp", "methods/wavelet_fog/decomposition_test.cpp"
COMPRESSION = "methods/wavelet_fog/compression.cpp", "methods/wavelet_fog/compression_test.cpp"
BETWEEN = "methods/wavelet_fog/interpolation.h", "methods/wavelet_fog/sun_test.cpp"
SUN = "methods/wavelet_fog/sun_scattering.cpp", "methods/wavelet_fog/sun_test.cpp"
PATHS = "methods/wavelet_fog/path_table.cpp", "methods/wavelet_fog/band_grid_test.cpp"


def bug(name, place, old, new, test, compiled=()):
    changes = ((old, new),) if isinstance(old, str) else tuple(zip(old, new))
    return Mutant(name, place[0], changes, place[1], test, tuple(compiled))


MUTANTS = [
    # Files
    bug("corners on a diagonal lie outside", POLYGONS, "turn_of(c, a, p) >= 0) {", "turn_of(c, a, p) > 0) {",
        "concave polygons are cut without a loss"),
    bug("polygons that cross themselves cut", POLYGONS, "if (turn_at(at) < 0) return std::nullopt;", "",
        "polygons without area or such as cross themselves"),
    bug("edges of the polygon within a triangle at a shared corner", POLYGONS, "if (leads_in(before_[p]) || leads_in(after_[p])) return false;",
        "", "corners that several parts of a polygon share"),
    bug("edges that run back along themselves kept", POLYGONS, "if (left_ > 3 && is_fold(j))", "if (left_ > 3 && is_fold(j) && false)",
        "corners that several parts of a polygon share"),
    bug("written through a link", ATOMIC, "if (::lstat(path", "if (::stat(path", "what a link leads to stays as it was"),
    bug("the store for everybody", STORE, "::mkdir(folder.c_str(), 0700)", "::mkdir(folder.c_str(), 0777)",
        "what is kept is for the user alone"),
    bug("another entry with its checksum", ENTRIES, "if (found == noted) return file;",
        "if (found.substr(0, 32) == noted.substr(0, 32)) return file;", "an entry of a store stands for no other"),
    bug("a state without a checksum", SIMULATION, "all.size() < sum || content_key(all.substr(0, all.size() - sum)) != all.substr(all.size() - sum)",
        "all.size() < sum", "a simulation's files that changed are refused, and named"),
    bug("frames without a checksum", SIMULATION, 'line != sum + " " + name', 'line.substr(33) != name',
        "a simulation's files that changed are refused, and named"),
    bug("a history without a checksum", SIMULATION, 'check("history.csv", content_key(history_));', "",
        "a simulation's files that changed are refused, and named"),
    bug("backdrops stay where they were", WRITE_SCENE, '"image", "depth", ', "", "all files of a base scene are found from elsewhere"),
    bug("sequences stay where they were", WRITE_SCENE, "if (text.find('#') == std::string::npos) return text;", "return text;",
        "all files of a base scene are found from elsewhere"),
    bug("line ends in names of TOML", TOML, "static_cast<unsigned char>(c) < 0x20 || ", "", "all files of a base scene are found from elsewhere"),
    bug("an instance with the place of its parent", INSTANCES,
        "grid->setTree(Reader().read(stream, *parent)->baseTreePtr());\n    return grid;", "return Reader().read(stream, *parent);",
        "grids that share samples are read"),
    bug("white of other primaries", COLOURS, " ||\n      differ(found.white, expected.white))", ")",
        "a picture with other primaries is refused"),
    # Shadow planes
    bug("edges of more than two faces count twice", SILHOUETTE, "k < edge.first + edge.count",
        "k < edge.first + std::min(edge.count, 2)", "shadow planes: edges of many faces count every one"),
    bug("multiplicity at most two", SILHOUETTE, "from_light[edge.b], sum}", "from_light[edge.b], std::min(sum, 2)}",
        "shadow planes: edges of many faces count every one"),
    bug("multiplicity at most two, the other way", SILHOUETTE, "from_light[edge.a], -sum}",
        "from_light[edge.a], std::min(-sum, 2)}", "shadow planes: edges of many faces count every one"),
    # Speed-ups
    bug("rows below the noise floor on curves", COMPARISONS, "error && !below", "error", "rows below the noise floor are on no curve"),
    bug("noise floor of any metric", COMPARISONS, "m.name == metric && m.below_floor", "m.below_floor",
        "scenes, methods and metrics are kept apart"),
    bug("speed-ups of all scenes together", COMPARISONS,
        "if (row.scene == scene && row.method == method) {\n      const auto time", "if (row.method == method) {\n      const auto time",
        "scenes, methods and metrics are kept apart"),
    bug("preparation of the other way round", COMPARISONS,
        "preparation(outcome, scene, s.method) - preparation(outcome, scene, s.baseline)",
        "preparation(outcome, scene, s.baseline) - preparation(outcome, scene, s.method)", "how many renders repay a preparation"),
    bug("renders that repay rounded down", COMPARISONS, "std::ceil(longer / saved)", "std::floor(longer / saved)",
        "how many renders repay a preparation"),
    bug("front of all scenes together", COMPARISONS, "row.scene != scene || !time", "!time", "the front is that of each scene"),
    bug("arithmetic mean of speed-ups", FRONT, ("sum += ratio;", "Gain{std::exp(sum / (steps + 1))"),
        ("sum += std::exp(ratio);", "Gain{sum / (steps + 1)"), "gains are geometric means over what both reach"),
    bug("one step too few in the mean", FRONT, "std::exp(sum / (steps + 1))", "std::exp(sum / std::max(1, steps))",
        "gains are geometric means over what both reach"),
    bug("curves that meet in one error lie apart", FRONT, "first.error.value < best", "first.error.value <= best",
        "two curves without a common error say which one is closer"),
    bug("a point dominates itself", FRONT, "return no_worse && (p.time.high < q.time.low || p.error.high < q.error.low);",
        "return no_worse;", "a point whose intervals overlap another's does not dominate it"),
    bug("dominance by values", FRONT, "const bool no_worse = p.time.high <= q.time.low &&", "const bool no_worse = p.time.value <= q.time.value &&",
        "a point whose intervals overlap another's does not dominate it"),
    bug("a loaded machine from 10 % on, that itself included", CONDITIONS, "row.waited > much_waiting", "row.waited >= much_waiting",
        "a loaded machine is named in the conditions"),
    bug("the wrong side of an error's interval", DRAWN_AGAIN, "e.value + z *", "e.value - z *", "an error is drawn as lopsided as its interval is, and above 0"),
    bug("the lower side up to one standard deviation", DRAWN_AGAIN, "z < 0 ?", "z < 1 ?", "an error is drawn as lopsided as its interval is, and above 0"),
    bug("least error twice as large", DRAWN_AGAIN, "1e-3 * e.value", "2e-3 * e.value", "an error is drawn as lopsided as its interval is, and above 0"),
    bug("intervals of one standard deviation", DRAWN_AGAIN, "normal_quantile(0.975)", "normal_quantile(0.84)",
        "an error is drawn as lopsided as its interval is, and above 0"),
    bug("one round fewer than there were runs", DRAWN_AGAIN, "std::size_t k = 0; k < row.times", "std::size_t k = 1; k < row.times",
        "a time is the median of as many draws as there were runs"),
    # Times
    bug("warm-up without the first render", TIMING, "double warmed = job_.first;", "double warmed = 0;", "how long a job is warmed up"),
    bug("warm-up that ends while it gets slower", TIMING, "std::abs(now - last_median)", "(now - last_median)", "how long a job is warmed up"),
    bug("warm-up that ends at 2 %", TIMING, "0.01 * now", "0.02 * now", "how long a job is warmed up"),
    bug("warm-up against the first render alone", TIMING, "      last_median = now;\n", "", "how long a job is warmed up"),
    bug("caches found by jobs of 20 ms too", TIMING, "short_job = 0.01", "short_job = 0.02", "jobs at the border of short and long"),
    bug("a second is long", TIMING, "job.first > 1 ?", "job.first >= 1 ?", "jobs at the border of short and long"),
    bug("a budget reached is passed", TIMING, "job_.first <= rule_.budget", "job_.first < rule_.budget", "jobs at the border of short and long"),
    # Gates
    bug("exact figures called Monte Carlo", GATES, "m.low < m.high", "m.low <= m.high", "a gate says what kind of figure it judged, and the figure"),
    bug("noise of another metric", GATES, "m.name == metric && (m.floor", "m.name != metric && (m.floor",
        "a gate says what kind of figure it judged, and the figure"),
    bug("margins: one class too low", MARGINS, "ratio <= 3 ", "ratio < 3 ", "margins are counted up to the end of each class"),
    bug("margins: a bound of 0 on a negative figure", MARGINS, "above < 0 && below < 0", "above <= 0 && below < 0",
        "the margin of a gate is how many times worse its figure could be"),
    bug("exposure by the 95 % quantile", EXPOSURE, "0.99 * double", "0.95 * double", "a picture's exposure shows its 99 % quantile as 0.8"),
    # Bounds by row and the figures of the pages
    bug("twice the figure", TIGHTEN, "return 1.5 if", "return 2 if", "Tighten.test_bounds"),
    bug("1e-3 counts as large", TIGHTEN, "x > 1e-3 else", "x >= 1e-3 else", "Tighten.test_the_rule_at_its_ends"),
    bug("1e-6 counts as middling", TIGHTEN, "x > 1e-6 else", "x >= 1e-6 else", "Tighten.test_the_rule_at_its_ends"),
    bug("3e-8 counts as rounding", TIGHTEN, "value <= 2e-8", "value <= 3e-8", "Tighten.test_the_rule_at_its_ends"),
    bug("negative figures held from the wrong side", TIGHTEN, "else value / factor(-value)", "else value * factor(-value)",
        "Tighten.test_the_rule_at_its_ends"),
    bug("negative figures held too closely from below", TIGHTEN, "else value * factor(-value)", "else value / factor(-value)",
        "Tighten.test_the_rule_of_intervals"),
    bug("intervals cut at their inner side", TIGHTEN, "high if low == high else rounded(high, True)", "high if low == high else rounded(high, False)",
        "Tighten.test_the_rule_of_intervals"),
    bug("counters within 2 %", TIGHTEN, "value * 1.01", "value * 1.02", "Tighten.test_the_rule_of_counters_and_laws"),
    bug("the laxest law", TIGHTEN, "law_most = min(", "law_most = max(", "Tighten.test_the_rule_of_counters_and_laws"),
    bug("figures that touch a law are beyond it", TIGHTEN, "found[1] > law_most", "found[2] > law_most", "Tighten.test_the_rule_of_counters_and_laws"),
    bug("bounds of profile paper", TIGHTEN, '"quick" in gate', '"paper" in gate', "Tighten.test_the_rule_of_counters_and_laws"),
    bug("a bound twice as far", TIGHTEN, "SLACK = 1.1 ", "SLACK = 2.2 ", "Tighten.test_how_far_a_bound_may_be"),
    bug("shares of the greatest", FIGURES, "Selection([sum(s.values)])", "Selection([max(s.values)])", "Figures.test_functions"),
    bug("above and equal", FIGURES, "float(v > bound)", "float(v >= bound)", "Figures.test_functions"),
    bug("verdicts are true whatever the tables say", FIGURES, "if not entry.holds():", "if entry.holds() is None:",
        "Claims.test_a_verdict_that_is_no_longer_true"),
    bug("noise hides nothing", FIGURES, "not low <= 0 <= high", "not low < 0 < high", "Figures.test_puts_the_figures_in"),
    bug("stale pictures go unseen", GALLERY, "if not absent and (b", "if absent and (b", "Gallery.test_renders_what_has_changed"),
    # The steps of a first-time user.
    bug("setup --check goes on to install", SETUP, "--check) check=1", "--check) check=", "Setup.test_check_lists_and_installs_nothing"),
    bug("setup installs without asking", SETUP, '[ -z "$yes" ]; then', '[ -n "$yes" ]; then', "Setup.test_on_a_terminal_it_asks_once"),
    bug("setup accepts any processor", SETUP, "avx2 bmi2 fma; do", "bmi2 fma; do", "Setup.test_a_processor_without_avx2"),
    bug("more jobs than memory", BUILD, '"$fit" -lt "$jobs"', '"$fit" -gt "$jobs"', "Build.test_fewer_jobs_where_memory_is_short"),
    bug("errors of a build in a pipe are lost", BUILD, "printf '%s\\n' \"$line\"", ":", "Build.test_progress_in_a_pipe"),
    # Masks
    bug("pixels that touch a light compared", RUN, "scene::ball_mask(scene, judged->view)", "std::vector<unsigned char>()",
        "rows leave out balls and background"),
    bug("ball mask ignored by metrics", VALUES, "if (!masks.left_out.empty() && masks.left_out[p]) kept_[p] = 0;", "",
        "what is left out counts nowhere"),
    bug("ball mask ignored by tests of equality", EQUALITY, "if (left_out.empty() || !left_out[pixel]) index", "index", "one block by hand"),
    bug("foreground of all pixels", PLAN, "(1 - t > 1e-3).any()", "(1 - t >= 0).any()", "rows leave out balls and background"),
    bug("foreground from 1e-4 in the driver", PLAN, "1 - t > 1e-3", "1 - t > 1e-4", "rows leave out balls and background"),
    bug("foreground from 1e-2 in the driver", PLAN, "1 - t > 1e-3", "1 - t > 1e-2", "rows leave out balls and background"),
    bug("foreground from 2e-3", METRICS, "1 - t[i] > 1e-3", "1 - t[i] > 2e-3", "the foreground begins at 1e-3"),
    bug("foreground from 5e-4", METRICS, "1 - t[i] > 1e-3", "1 - t[i] > 5e-4", "the foreground begins at 1e-3"),
    bug("foreground ignored", VALUES, "if (name.foreground && !masks.foreground[p]) kept_[p] = 0;", "",
        "what is left out counts nowhere"),
    # Noise
    bug("count_noise inverted", PICTURES, "ImageNoise::counted : ImageNoise::removed", "ImageNoise::removed : ImageNoise::counted",
        "noise of references and images reaches the rows"),
    bug("noise layers of the reference stripped", PICTURES, "measure({metric}, film, truth,",
        "measure({metric}, film, without_noise_layers(truth),", "noise of references and images reaches the rows"),
    bug("noise layers of the image stripped", PICTURES, "measure({metric}, film, truth,",
        "measure({metric}, without_noise_layers(film), truth,", "noise of references and images reaches the rows"),
    bug("what a method adds against the scene's own truth", ("experiments/driver/pictures.cpp", "experiments/conversion_test.cpp"),
        "is_of_converted(metric) ? converted", "is_of_converted(metric) ? reference",
        "rows of converted media have two errors, and what the conversion lost and took"),
    bug("Gaussians cut that should go on", ("scene/convert/medium_form.cpp", "scene/convert/medium_form_test.cpp"), "if (!c.cut)", "if (c.cut)",
        "Gaussians are cut as they were fitted, or go on"),
    bug("rel_mse from one half", METRICS, "0.5 * (one_way(first, second) + one_way(second, first))", "one_way(first, second)",
        "rel_mse uses both halves, each above the other"),
    bug("rel_mse over its own half", METRICS, "one_way(first, second) + one_way(second, first)", "one_way(first, first) + one_way(second, second)",
        "rel_mse uses both halves, each above the other"),
    bug("rel_mse keeps the bias of its denominator", METRICS, "jackknife(corrected ? jackknife_value(whole, without) : whole,",
        "jackknife(whole,", "rel_mse uses both halves, each above the other"),
    bug("percentiles without their tails", METRICS, "const double tail = removed ? (1 - p) / 2 : 0;", "const double tail = 0;",
        "percentiles and their tails by hand"),
    bug("percentiles without noise", METRICS, "const double noise_bound = quantile(noise, 1 - tail);", "const double noise_bound = 0;",
        "percentiles and their tails by hand"),
    bug("bias without the image's own noise", COUNTED, "with_interval(v, variance / (reference * reference), false, signed_bias)",
        "with_interval(v, 0, false, signed_bias)", "counted noise of few samples: intervals from standard errors"),
    bug("squares without the image's own noise", COUNTED, "  if (!v.only_errors()) return 0;\n", "  if (true) return 0;\n",
        "counted noise of few samples: intervals from standard errors"),
    bug("channels of a pixel independent", COUNTED, "of_pixel += error(i);", "of_pixel = std::hypot(of_pixel, error(i));",
        "counted noise: one pixel by hand"),
    bug("deleted batches leave their noise", COUNTED, "return plain - excess;", "return plain;",
        "counted noise of sixteen batches: intervals from the jackknife"),
    bug("a pixel without contributing sample is exact", BATCHES, "if (errors[i] > 0 &&", "if (errors[i] < 0 &&",
        "a pixel without a contributing sample is not exact"),
    bug("three batches are enough", BATCHES, "found.size() < 4", "found.size() < 3", "batches are found by their layer, four or more"),
    # Statistics
    bug("jackknife without (n-1)/n", STATISTICS, "(groups - 1) / groups * sum", "sum", "a jackknife by hand"),
    bug("jackknife with a normal quantile", STATISTICS, "student_quantile(0.975, degrees) * std::sqrt(all)", "normal_quantile(0.975) * std::sqrt(all)",
        "a jackknife by hand"),
    bug("jackknife of 90 %", STATISTICS, "student_quantile(0.975, degrees) * std::sqrt(all)", "student_quantile(0.95, degrees) * std::sqrt(all)",
        "a jackknife by hand"),
    bug("power of the central t", STATISTICS, "return 0.5 * (low + high);", "return threshold + normal_quantile(power);",
        "a detectable shift is found as often as it says"),
    bug("detectable_bias without power", EQUALITY, "detectable_shift(student_quantile(1 - alpha / 6, whole.degrees), whole.degrees, 0.95)",
        "student_quantile(1 - alpha / 6, whole.degrees)", "detectable_bias is found with probability 0.95"),
    bug("detectable_bias at half the power", EQUALITY, "whole.degrees, 0.95)", "whole.degrees, 0.5)", "one block by hand"),
    bug("the lower tail of chi-square forgotten", EQUALITY,
        "known.count ? chi_square_below(known.sum, double(known.count)) : 1", "1", "shared random numbers scatter too little"),
    bug("alpha not shared", EQUALITY, "normal_quantile(1 - alpha / 6)", "normal_quantile(1 - alpha / 2)", "one block by hand"),
    bug("skewness of no account", EQUALITY, "if (!e.blocks_in_range) {", "if (false) {", "fireflies are out of the tests' range"),
    # Lights
    bug("a linear spot cone", ("scene/light/light.cpp", "scene/light_test.cpp"), "return s * s * (3 - 2 * s);", "return s;",
        "a spot light has a full cone, a dark outside and a smooth edge"),
    # Oracle vectors
    bug("tolerances ten times as wide", CHECK, "std::abs(got - expected) <= tolerance", "std::abs(got - expected) <= 10 * tolerance",
        "tolerances are what they say"),
    bug("relative tolerances ten times as wide", CHECK, "tolerance * std::abs(expected) + floor", "10 * tolerance * std::abs(expected) + floor",
        "tolerances are what they say"),
    bug("standard errors added", CHECK, "std::hypot(expected_se, got_se)", "expected_se + got_se", "tolerances are what they say"),
    bug("a reader's own tolerance", ("experiments/verify/fields.cpp", "experiments/verify_tolerances_test.cpp"),
        "{0, s.length})[0], accuracy)", "{0, s.length})[0], 10 * accuracy)", "readers use the tolerance of the vector"),
    bug("a second reader's own tolerance", ("experiments/verify/single_scattering.cpp", "experiments/verify_tolerances_test.cpp"),
        "relative(std::move(what), expected, got.radiance[0], tolerance)", "relative(std::move(what), expected, got.radiance[0], 10 * tolerance)",
        "readers use the tolerance of the vector"),
    bug("relative errors with their sign", VERIFY, "std::abs(c.got - c.expected) / std::abs", "(c.got - c.expected) / std::abs",
        "the figures of a kind are those of its worst number"),
    bug("relative to what is expected, sign and all", VERIFY, "/ std::abs(c.expected)", "/ c.expected", "the figures of a kind are those of its worst number"),
    bug("kinds of all files together", VERIFY, "line.file == file && line.kind", "line.kind", "the figures of a kind are those of its worst number"),
    bug("nothing compared is a success", VERIFY, "return totals.out || totals.numbers == 0 ? 1 : 0;", "return totals.out ? 1 : 0;",
        "a file without vectors is no success"),
    bug("numbers out forgiven", VERIFY, "return totals.out || totals.numbers == 0 ? 1 : 0;", "return totals.numbers == 0 ? 1 : 0;",
        "a number out of tolerance is found"),
    # Path tracer
    bug("a cell forgets Gaussians that count", CELLS, "negligible = 60 * std::log(2.0)", "negligible = 20 * std::log(2.0)",
        "the Gaussians that count in a cell give the density of all"),
    # Stable Fluids
    bug("buoyancy of warmth 10 % too strong", FORCES, "0.5 * dt * gravity[a] * expansion", "0.55 * dt * gravity[a] * expansion",
        "stable fluids: a warm column accelerates as its expansion says, a heavy one as its weight does"),
    bug("buoyancy of weight 10 % too strong", FORCES, "0.5 * dt * gravity[a] * weight", "0.55 * dt * gravity[a] * weight",
        "stable fluids: a warm column accelerates as its expansion says, a heavy one as its weight does"),
    bug("sources 5 % too strong", FORCES, "Real(part.length() * (smoke", "Real(1.05 * part.length() * (smoke",
        "stable fluids: a source brings its rate times its volume times its time"),
    bug("sources act over whole steps", FORCES, "Real(part.length() * (smoke", "Real(dt * (smoke",
        "stable fluids: a source brings its rate times its volume times its time"),
    bug("vorticity confinement 30 % too strong", FORCES, "Real(epsilon * l.h)", "Real(1.3 * epsilon * l.h)",
        "stable fluids: confinement accelerates a shear by epsilon h times its vorticity"),
    bug("vorticity by half of the differences", FORCES, "Real(0.25 / l.h)", "Real(0.125 / l.h)",
        "stable fluids: confinement accelerates a shear by epsilon h times its vorticity"),
    bug("a swinging force as at the step's start", FORCES, "(std::sin(w * part.hi) - std::sin(w * part.lo)) / w", "std::cos(w * part.lo) * part.length()",
        "stable fluids: a force that swings brings the integral of its cosine"),
    bug("the layer of cells around obstacles counts as clear", OBSTACLES, "std::max(0, layer - 1)", "std::max(0, layer)",
        "stable fluids: what is solid of a ball, and how far it is to it"),
    bug("obstacles a layer of cells too large", OBSTACLES, "hits[passed].position[0] <= x)", "hits[passed].position[0] <= x + (passed % 2 ? -l.h : l.h))",
        "stable fluids: what is solid of a ball, and how far it is to it"),
    bug("decay by a step of Euler", GRID_FLOW, "std::exp(-problem_->decay * dt)", "1 - problem_->decay * dt",
        "stable fluids: smoke decays as the exponential of its rate"),
    bug("faces on a side have a whole cell of energy", FLOW_TOTALS, "? 0.25 : 0.5", "? 0.5 : 0.5",
        "stable fluids: the energy of a wind is half its square times the box, its mass the density's"),
    bug("a lid drags half", FLOW_DIFFUSION, "(on_faces ? 1 : 2) * share", "1 * share",
        "stable fluids: viscosity between a wall and a lid ends in Couette's straight line"),
    bug("energy grows against the previous frame", FLOW_METRICS, "before = std::min(before, t.energy)", "before = t.energy",
        "figures of flows by hand"),
    # Wavelet fog
    bug("coarse grids lose mass", WAVELETS, "scaled(-1, 0.125, {-1, 2, 6, 2, -1})", "scaled(-1, 0.125, {-1, 2, 5, 2, -1})",
        "wavelets: coarse grids keep the mass, restricted and clamped ones their sign"),
    bug("details reach a level too far", LEVELS, "length * std::pow(mu, m)", "length * std::pow(mu, m - 1)",
        "wavelet fog: the m-th level of details reaches mu^m of the way"),
    bug("blocks twice as coarse as their bound", BLOCKS, "i, j)] <= most)) --level", "i, j)] <= 2 * most)) --level",
        "wavelet fog: a bound below the error of a block asks for its cells"),
    bug("large wavelets weigh as small ones", COMPRESSION, "std::ldexp(1.0, l + 1)", "std::ldexp(1.0, 1)",
        "wavelet fog: of coefficients of all sizes those are kept that the map's norm needs most"),
    bug("slopes of a table's far ends the other way", BETWEEN, "- w * slope_b", "+ w * slope_b",
        "sun: a map's columns converge to the exact ones at every height", ["methods/wavelet_fog/sun_map.cpp"]),
    bug("between rows a straight line", BETWEEN, "0.5 * t * (p[2] - p[0] + t * (2 * p[0] - 5 * p[1] + 4 * p[2] - p[3] + t * (3 * (p[1] - p[2]) + p[3] - p[0])))",
        "t * (p[2] - p[1])", "sun: a map's columns converge to the exact ones at every height", ["methods/wavelet_fog/sun_map.cpp"]),
    bug("the sun scattered backwards", SUN, "sun.light.to_light.dot(ray.direction)", "-sun.light.to_light.dot(ray.direction)",
        "sun: pictures equal the quadrature's"),
    bug("all that is lost from a ray is scattered", SUN, "m->albedo * m->sigma_t * p", "m->sigma_t * p",
        "sun: in even fog under a flat top the light is a closed form"),
    bug("moments of half a part of the way", PATHS, "+= share * piece", "+= half * piece",
        "wavelet fog: tables know factors of the height that are straight along a cell"),
    # Discrete ordinates, harmonics, fits, residuals, projection
    bug("a whole cell before the first node", ORDINATE_SWEEP, "w.depth = 0.5 * way.step * extinct;", "w.depth = way.step * extinct;",
        "discrete ordinates: slabs"),
    bug("all bands scatter as the mean does", ORDINATES, "phase_[std::size_t(std::sqrt(double(c % bands)))]", "phase_[0]", "discrete ordinates: slabs"),
    bug("thin cells with a wrong series", ORDINATE_SWEEP, "t * (0.5 - t * (1. / 3 - t * (1. / 8", "t * (0.5 - t * (1. / 2 - t * (1. / 8",
        "discrete ordinates: thin smoke in light that grows along a line"),
    bug("the error as if nothing scattered again", ORDINATES, " / std::max(least, 1e-6)", "", "discrete ordinates: the error that is reported bounds that of slow convergence"),
    bug("sources beyond a face are those before it", ORDINATE_SWEEP, "(1.5 * here - 0.5 * down)", "here",
        "discrete ordinates: thin smoke in light that grows along a line"),
    bug("products of two equal indices are even", PRODUCTS, "product[i] += value * (h[i] * f[k] + h[k] * f[i]);\n      product[k]",
        "product[i] += value * (2 * h[i] * f[k]);\n      product[k]", "deterministic vectors verify at their stated tolerance"),
    bug("products without the highest bands", PRODUCTS, "c.l > a.l + b.l", "c.l >= a.l + b.l", "deterministic vectors verify at their stated tolerance"),
    bug("products by too few nodes", PRODUCTS, "(3 * order) / 2 + 1", "order", "deterministic vectors verify at their stated tolerance"),
    bug("a warm start in densities of the smoke", FIT, "g.amplitude / greatest_}", "g.amplitude}",
        "the next frame begins with the Gaussians of the frame before, whatever its greatest density"),
    bug("deletion by the square of the width", FIT, "std::pow(gaussians_[i].width, 3)", "std::pow(gaussians_[i].width, 2)",
        "the Gaussian that is deleted is the one whose samples have the least sum of squares"),
    bug("half of what a place gains", PLACEMENT, "-2 * g.amplitude * with_error - g", "-g.amplitude * with_error - g",
        "what a Gaussian gains at its place is what the objective loses"),
    bug("levels rounded down", RESIDUAL, "std::round(residual[i] / levels.step)", "std::floor(residual[i] / levels.step)",
        "Gaussians and residual give the grid back to half a level"),
    bug("levels at the threshold are kept", RESIDUAL, "std::abs(level) > options.threshold", "std::abs(level) >= options.threshold",
        "a threshold leaves out the levels up to it"),
    bug("Lanczos' factors of one coefficient more", PROJECTION, "std::sin(pi * k / n) / (pi * k / n)", "std::sin(pi * k / (n + 1)) / (pi * k / (n + 1))",
        "a square column: what a jump costs, with and without Lanczos' factors"),
    bug("the limiter leaves what is below 0", PROJECTION, "(1 - margin) * mean / (mean - least)", "(1 + 20 * margin) * mean / (mean - least)",
        "the limiter leaves a positive polynomial of the same mass"),
    bug("what is below 0 counts in the clamped error", PROJECTION, "(std::max(0.0, o) - e) * (std::max(0.0, o) - e)", "(o - e) * (o - e)",
        "what is below 0 of a projection, and the error without it, by hand"),
    bug("the share below 0 of a box of one", PROJECTION, "below / 8", "below / 4", "what is below 0 of a projection, and the error without it, by hand"),
    # Legendre fluids
    bug("a filter that forgets that indices begin at 0", LEGENDRE_FILTER, "double(m) / (n - 1)", "double(m) / n",
        "legendre fluids: a filter takes its rate from the highest index, and powers of the share from the others"),
    bug("the projection adds the gradient", CONFINED, "rate > 0 ? -1 / rate", "rate > 0 ? 1 / rate",
        "legendre fluids: the projection holds in boxes that are no cubes, up to 32 coefficients"),
    bug("the pressure of a cube", CONFINED, "rate += wall_rates_[i[a] - 1] / (half_[a] * half_[a])", "rate += wall_rates_[i[a] - 1]",
        "legendre fluids: the projection holds in boxes that are no cubes, up to 32 coefficients"),
    bug("forces act after the flow", LEGENDRE_FLOW, "{{{0.5 * dt, first, first}, {0.5 * dt, second, second}}}",
        "{{{0.5 * dt, first, none}, {0.5 * dt, second, all}}}", "legendre fluids: what acts on a flow is of second order in the step"),
    bug("air comes in where it goes out", CONFINED, "(side ? Array(-speed) : speed)", "(side ? speed : Array(-speed))",
        "legendre fluids: what comes in clear can only thin what is there"),
    bug("viscosity in half sizes", BOXES, "rate += (*rates[a])[i[a]] / (half_[a] * half_[a])", "rate += (*rates[a])[i[a]]",
        "legendre fluids: Taylor-Green vortices agree with the closed form in boxes of any size"),
    bug("the last slope half a step ahead", TIME_STEPS, "k4 = rate(y + dt * k3)", "k4 = rate(y + 0.5 * dt * k3)",
        "legendre fluids: Runge-Kutta keeps the energy within the step rule"),
    bug("what is below 0 is integrated", LEGENDRE_LINE, "rises ? Interval{root, t.hi} : Interval{t.lo, root}",
        "rises ? Interval{t.lo, root} : Interval{root, t.hi}", "a Legendre box clamped between two roots, in closed form"),
    bug("pieces begin from nothing", LEGENDRE_LINE, "positive_.empty() ? 0 : integral(positive_.back().hi)", "0.0",
        "integrals through Legendre boxes agree with fine sums, and add up"),
    bug("each stretch sees its own depth alone", LIGHT_RAYS, "std::sqrt(2.0) * before[m]", "0 * before[m]",
        "legendre light: rays equal quadrature at every optical depth"),
    bug("forward is backward", LIGHT_PHASES, "lit.lights[l].to_light.dot(ray.direction)", "-lit.lights[l].to_light.dot(ray.direction)",
        "legendre light: pictures equal the quadrature's"),
    bug("light from behind an end is not dimmed before it", PAPER_VIEW, "(-sigma_t_ * row.column[pixel]).exp() * in_channels(lane)",
        "in_channels(lane)", "legendre light: air before an end sends the integral of what the system's series scatters"),
    bug("columns to the end of the box", PAPER_VIEW, "return std::min(clipped.leave[x], row.end[x]);", "return clipped.leave[x];",
        "legendre light: air before an end sends the integral of what the system's series scatters"),
    bug("a shadowgram of where light comes in", PAPER_PICTURE, "field_->local(ray.at(t.lo))", "field_->local(ray.at(t.hi))",
        "legendre light: E_d casts the medium's shadowgram on what lies behind"),
    bug("the third slope of particles from the step's end", PARTICLES, "slope(b, 0.5 * dt, 0.5)", "slope(b, 0.5 * dt, 1)",
        "the velocity between two states of a flow is linear in time"),
    # Compensated ray marching
    bug("wide phase functions are warned of", SMOKE_OPTIONS, "left_out > most_left_out", "left_out < most_left_out",
        "compensated march, stress list: narrow phase functions keep the light's mean, and are warned of"),
    bug("thin smoke is warned of for its orders", SMOKE_OPTIONS, "if (!paper && again)", "if (!paper)",
        "compensated march, stress list: narrow phase functions keep the light's mean, and are warned of"),
    bug("albedo 0 is singular", SMOKE_OPTIONS, "(medium.albedo == 1 && medium.sigma_t > 0)", "(medium.albedo == 0 && medium.sigma_t > 0)",
        "compensated march, stress list: albedo 1 is refused where the system is singular"),
    bug("no density is small beside 1", SMOKE, "least_source_share * g.amplitude", "least_source_share",
        "compensated march, stress list: densities are seen beside extinction alone"),
    bug("sources below 0", SMOKE_PICTURE, "(weighted[std::size_t(k)] / of_gaussians).max(0)", "(weighted[std::size_t(k)] / of_gaussians)",
        "compensated march, stress list: pictures of both variants"),
    bug("thin smoke scatters again", CENTRES, "most < options.tolerance", "most < 0",
        "compensated march: paper leaves out what is less than the tolerance, and a residual of nothing"),
    bug("columns without a width", CENTRES, "std::sqrt(pi) * g.width", "std::sqrt(pi)",
        "compensated march: paper leaves out what is less than the tolerance, and a residual of nothing"),
    bug("a residual of nothing", SMOKE_KEPT, "return level != 0;", "return level != -128;",
        "compensated march: paper leaves out what is less than the tolerance, and a residual of nothing"),
]
