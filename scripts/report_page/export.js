// Buttons that save a table or a plot: as CSV, or as LaTeX for booktabs or pgfplots.
const saveButtons = (name, texts) => {
  const span = document.createElement("span");
  span.className = "save";
  for (const [ending, text] of Object.entries(texts)) {
    const button = document.createElement("button");
    button.textContent = ending === "csv" ? "CSV" : "LaTeX";
    button.title = `save as ${ending === "csv" ? "CSV" : "LaTeX"}`;
    button.addEventListener("click", () => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([text()], { type: "text/plain" }));
      link.download = `${name.replace(/[^\w.-]+/g, "_")}.${ending}`;
      link.click();
    });
    span.append(button);
  }
  return span;
};

const csvText = rows => rows.map(row => row.map(cell =>
  /[",\n]|^#/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell).join(",") + "\n").join("");

const latexText = text => text.replace(/[\\{}&%$#_~^<>[\]]/g, c => ({
  "\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}", "<": "\\textless{}", ">": "\\textgreater{}",
  "[": "{[}", "]": "{]}" })[c] || `\\${c}`);

const latexTable = (title, [head, ...rows]) => {
  const line = cells => cells.map(latexText).join(" & ") + " \\\\\n";
  return `% \\usepackage{booktabs}\n\\begin{table}\n\\centering\n\\caption{${latexText(title)}}\n` +
    `\\begin{tabular}{${"l".repeat(head.length)}}\n\\toprule\n${line(head)}\\midrule\n` +
    `${rows.map(line).join("")}\\bottomrule\n\\end{tabular}\n\\end{table}\n`;
};

// `data`: curve,x,x_low,x_high,y,y_low,y_high,floor in blocks, for each curve its values, then its upper bounds.
const latexPlot = (title, data) => {
  const point = line => {
    const [, name, numbers] = line.match(/^("(?:[^"]|"")*"|[^,]*),(.*)$/), [x, , , y] = numbers.split(",").map(parseFloat);
    return { name: name.replace(/^"|"$/g, "").replaceAll('""', '"'), x, y };
  };
  const blocks = data.split("\n\n\n").map(block => block.split("\n").filter(line => line && !line.startsWith("# ")).map(point));
  const mode = key => {
    const values = blocks.flat().map(p => p[key]).filter(Number.isFinite), above = values.filter(v => v > 0);
    return above.length && above.length === values.length && Math.max(...above) > 4 * Math.min(...above) ? "log" : "normal";
  };
  const [, y, x] = title.match(/^(.*?) against (.*?)(?:: .*)?$/) || [];
  const labels = x ? `, xlabel={${latexText(x)}}, ylabel={${latexText(y)}}` : "";
  const curves = blocks.map((block, i) => {
    const points = block.filter(p => Number.isFinite(p.x) && Number.isFinite(p.y)).map(p => `(${p.x},${p.y})`);
    if (!points.length) return "";
    const bounds = i % 2 ? "[only marks, mark=triangle, mark options={rotate=180}, forget plot]" : "";
    return `\\addplot${bounds} coordinates {${points.join(" ")}};${bounds ? "  % below noise: upper bounds" : ""}\n` +
      (bounds ? "" : `\\addlegendentry{${latexText(block[0].name)}}\n`);
  });
  return "% \\usepackage{pgfplots} \\pgfplotsset{compat=1.18}\n" +
    `\\begin{tikzpicture}\n\\begin{axis}[title={${latexText(title)}}${labels},\n` +
    `  xmode=${mode("x")}, ymode=${mode("y")}, legend pos=outer north east]\n${curves.join("")}\\end{axis}\n\\end{tikzpicture}\n`;
};

const saveTable = (title, rows) => saveButtons(title, { csv: () => csvText(rows), tex: () => latexTable(title, rows) });
const savePlot = (title, data) => saveButtons(title, { csv: () => data, tex: () => latexPlot(title, data) });
