// `airlight results`: what it writes of small records, to the byte, and what it refuses.
#include <catch2/catch.hpp>

#include "experiments/driver/export.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace results_test {

using namespace airlight::test;
using Catch::Contains;

namespace {

// An entry of `errors`; noise is 0.5 of the upper end where the error is below it.
std::string error(const std::string& metric, const std::string& value, const std::string& low, const std::string& high,
                  bool below = false) {
  return R"({"metric": ")" + metric + R"(", "value": )" + value + R"(, "low": )" + low + R"(, "high": )" + high +
         R"(, "noise_floor": )" + (below ? "0.25" : "0") + R"(, "below_noise_floor": )" + (below ? "true" : "false") +
         "}";
}

std::string row(const std::string& method, const std::string& setting, const std::string& settings,
                const std::string& errors, const std::string& seconds, const std::string& more) {
  return R"({"key": "k", "scene": "fog_1", "method": ")" + method + R"(", "setting": ")" + setting +
         R"(", "renderer": "ray_marcher", "settings": ")" + settings +
         R"(", "layer": "mean", "film": [16, 12], "scene_hash": "h", "reference": "r", "errors": [)" + errors +
         R"(], "unavailable": false, "runs": )" + (seconds.empty() ? "0" : "3") + R"(, "seconds": [)" +
         (seconds.empty() ? "0, 0, 0" : seconds) +
         R"(], "seconds_interval_coverage": 0.75, "seconds_mad": 0, "prepare_seconds": 0.001, "stages": [], "device": "",)" +
         R"("image": "", "exposure": 0, )" + more + "}";
}

const std::string rows =
    row("march", "4", "steps=4 kernel=scalar", error("rel_l2", "0.25", "0.2", "0.3"), "0.002, 0.001, 0.004",
        R"("note": "", "counters": {"rays": 192}, "moved": {"camera": {"seconds": 0.0025, "anew": false}})") +
    "," +
    row("march", "16", "steps=16 kernel=scalar", error("rel_l2", "0.01", "0", "0.125", true), "0.008, 0.008, 0.008",
        R"("note": "", "counters": {})") +
    "," + row("a & b", "", "tile=8", "", "", R"("note": "not supported: no lamp", "counters": {})");

std::string record(const std::string& of_rows) {
  return R"({"experiment": "g/e", "profile": "quick", "title": "Steps, 100 %", "commit": "abc",
"machine": {"cpu": "A CPU", "threads": 2}, "plots": [{"file": "plots/p.svg", "title": "p"}], "rows": [)" +
         of_rows + "]}";
}

const std::string experiment = R"(title = "Steps"
layer = "airlight"
metrics = ["rel_l2"]
[[scene]]
file = "scenes/one.toml"
[reference]
renderer = "deterministic"
[[method]]
name = "march"
renderer = "ray_marcher"
[[plot]]
name = "p"
x = "setting"
x_label = "steps_n"
y = "rel_l2"
)";

struct Project : SmallProject {
  Project() : SmallProject(box_of_fog(16, 12), experiment) { write("results/g/e/run.json", record(rows)); }
  Result results(const std::string& words) const { return run("results " + words, *this); }
};

}  // namespace

TEST_CASE("results as CSV: a line for each figure, a column for each setting", "[results]") {
  const Project project;
  const std::string head = R"(g/e,quick,abc,"A CPU, 2 threads",CPU,16x12,fog_1,,)";
  const std::string march = head + "march,4,ray_marcher,mean,scalar,4,,",
                    finer = head + "march,16,ray_marcher,mean,scalar,16,,";
  const Result told = project.results("");
  CHECK(told.code == 0);
  CHECK(told.err.empty());
  CHECK(told.out ==
        "experiment,profile,commit,machine,device,film,scene,parameter,method,setting,renderer,layer,setting.kernel,"
        "setting.steps,setting.tile,metric,value,low,high,noise_floor,below_noise,note\n" +
            march + "rel_l2,0.25,0.2,0.3,0,false,\n" + march + "seconds,0.002,0.001,0.004,0,false,\n" + march +
            "prepare_seconds,0.001,0.001,0.001,0,false,\n" + march + "camera_seconds,0.0025,0.0025,0.0025,0,false,\n" +
            march + "counter.rays,192,192,192,0,false,\n" + finer + "rel_l2,0.01,0,0.125,0.25,true,\n" + finer +
            "seconds,0.008,0.008,0.008,0,false,\n" + finer + "prepare_seconds,0.001,0.001,0.001,0,false,\n" + head +
            "a & b,,ray_marcher,mean,,,8,,,,,,,not supported: no lamp\n");
  // A choice of rows and figures, into a file.
  const Result chosen = project.results("g --metric counter.rays --method march --scene fog_1 --out rays.csv");
  CHECK(chosen.code == 0);
  CHECK(chosen.out.empty());
  CHECK(airlight::read_bytes(project.file("rays.csv")) ==
        "experiment,profile,commit,machine,device,film,scene,parameter,method,setting,renderer,layer,setting.kernel,"
        "setting.steps,metric,value,low,high,noise_floor,below_noise,note\n" +
            head + "march,4,ray_marcher,mean,scalar,4,counter.rays,192,192,192,0,false,\n");
}

TEST_CASE("results as JSON lines", "[results]") {
  const Project project;
  const std::string head =
      R"({"experiment":"g/e","profile":"quick","commit":"abc","machine":"A CPU, 2 threads","device":"CPU","film":"16x12",)"
      R"("scene":"fog_1","parameter":null,)";
  CHECK(
      project.results("g/e --format jsonl --metric rel_l2").out ==
      head +
          R"("method":"march","setting":"4","renderer":"ray_marcher","layer":"mean","settings":{"steps":"4","kernel":"scalar"},)"
          R"("metric":"rel_l2","value":0.25,"low":0.2,"high":0.3,"noise_floor":0.0,"below_noise":false,"note":""})"
          "\n" +
          head +
          R"("method":"march","setting":"16","renderer":"ray_marcher","layer":"mean","settings":{"steps":"16","kernel":"scalar"},)"
          R"("metric":"rel_l2","value":0.01,"low":0.0,"high":0.125,"noise_floor":0.25,"below_noise":true,"note":""})"
          "\n" +
          head +
          R"("method":"a & b","setting":"","renderer":"ray_marcher","layer":"mean","settings":{"tile":"8"},)"
          R"("note":"not supported: no lamp"})"
          "\n");
}

TEST_CASE("results as a LaTeX table: the best is bold, and below noise says so", "[results]") {
  const Project project;
  CHECK(project.results("--format latex").out == R"(% g/e: \usepackage{booktabs,siunitx}
% Bold: the smallest error and the shortest time of a scene. A value below noise counts by its upper bound.
\begin{table}
\centering
\sisetup{detect-weight}
\caption{Steps, 100 \%. Scene: fog\_1; 16x12 pixels; profile quick; A CPU, 2 threads; airlight abc.}
\label{tab:g/e}
\begin{tabular}{llS[table-format=1.3]@{\enspace}lS[table-format=1.2]@{\enspace}l}
\toprule
method & setting & {relative L2 error} & {95\,\% interval} & {time of one render {[}ms{]}} & {interval} \\
\midrule
march & 4 & 0.250 & {[\num{0.200}, \num{0.300}]} & \bfseries 2.00 & {[\num{1.00}, \num{4.00}]} \\
march & 16 & {\bfseries below noise, $\le$ \num{0.125}} &  & 8.00 &  \\
a \& b &  & {--} &  & {--} &  \\
\bottomrule
\end{tabular}
\end{table}
)");
  CHECK(
      airlight::experiments::latex_text(R"(a_b^2 50% #1 {x} \ ~ <y> [z] $)") ==
      R"(a\_b\textasciicircum{}2 50\% \#1 \{x\} \textbackslash{} \textasciitilde{} \textless{}y\textgreater{} {[}z{]} \$)");
}

TEST_CASE("results as a plot for pgfplots: intervals as error bars, upper bounds as marks", "[results]") {
  const Project project;
  CHECK(project.results("--format pgfplots").out == R"(% g/e: \usepackage{pgfplots} \pgfplotsset{compat=1.18}
% relative L2 error against steps_n: fog_1
\begin{tikzpicture}
\begin{axis}[
  xlabel={steps\_n}, ylabel={relative L2 error},
  xmode=normal, ymode=normal,
  xmin=0, xmax=18.4, ymin=0, ymax=0.2875,
  legend style={at={(0.5,-0.22)}, anchor=north, draw=none, font=\footnotesize, cells={anchor=west}},
  legend columns=2, grid=major, grid style={gray!25}]
\definecolor{airlight0}{HTML}{0072B2}
\addplot[airlight0, mark=*, mark size=1.5pt, error bars/.cd, x dir=both, x explicit, y dir=both, y explicit]
  table[row sep=\\, x=x, y=y, x error minus=xm, x error plus=xp, y error minus=ym, y error plus=yp] {
x y xm xp ym yp\\
4 0.25 0 0 0.05 0.05\\
};
\addlegendentry{march}
\addplot[airlight0, only marks, mark=triangle, mark options={rotate=180}, forget plot]  % below noise: upper bounds
  table[row sep=\\, x=x, y=y] {
x y\\
16 0.125\\
};
\addplot[gray, dashed] coordinates {(0,0.25) (18.4,0.25)};
\addlegendentry{noise floor}
\end{axis}
\end{tikzpicture}
)");
}

TEST_CASE("results refuses what is not there in one line", "[results]") {
  const Project project;
  const auto refused = [&](const std::string& words) {
    const Result told = project.results(words);
    INFO(words << ": " << told.err);
    CHECK(told.code == 2);
    CHECK(told.out.empty());
    CHECK(told.error_lines() == 1);
    return told.err;
  };
  CHECK_THAT(refused("g/f"), Contains("no record 'g/f' below") && Contains("(nearest: g/e)"));
  CHECK_THAT(refused("--format tex"), Contains("expected one of csv, jsonl, latex, pgfplots"));
  CHECK_THAT(refused("--metric rel_l1"), Contains("--metric 'rel_l1'") && Contains("(nearest: rel_l2)"));
  CHECK_THAT(refused("--scene fog_2"), Contains("(nearest: fog_1)"));
  CHECK_THAT(refused("--method marsh"), Contains("(nearest: march)"));
  CHECK_THAT(refused("--profile big"), Contains("expected quick or paper"));
  CHECK_THAT(refused("--profile paper"), Contains("no records of profile paper"));
  CHECK_THAT(refused("--format pgfplots --metric rel_l2"), Contains("expected --format csv, jsonl or latex"));
  CHECK_THAT(refused("--format pgfplots --method 'a & b'"), Contains("no plots"));
  CHECK_THAT(refused("--out nowhere/x.csv"), Contains("nowhere"));
  project.write("results/g/e/run.json", R"({"rows": []})");
  CHECK_THAT(refused(""), Contains("run.json: not a record of this version"));
  project.write("results/g/e/run.json", "{");
  CHECK_THAT(refused(""), Contains("run.json: not JSON"));
}

}  // namespace results_test
