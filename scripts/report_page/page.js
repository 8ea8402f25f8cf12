// The index: a row is filled when it is opened; a search and filters choose the rows.
(() => {
  const index = document.getElementById("index");
  const add = (parent, tag, props = {}, ...children) => {
    const e = Object.assign(document.createElement(tag), props);
    e.append(...children);
    parent.append(e);
    return e;
  };
  const unpack = async text => {
    const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).json();
  };
  const number = /^[<>]?=?\s*[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?\s*%?$/i;
  const cells = (row, tag) => row.map(text => add(document.createDocumentFragment(), tag,
    { textContent: text, className: tag === "td" && number.test(text.trim()) ? "number" : "" }));
  const table = (parent, [head, ...rows]) => {
    const t = add(add(parent, "div", { className: "scroll" }), "table");
    add(add(t, "thead"), "tr", {}, ...cells(head || [], "th"));
    const body = add(t, "tbody");
    for (const row of rows) add(body, "tr", {}, ...cells(row, "td"));
  };
  // A part that is folded, and filled when it is opened.
  const folded = (parent, words, fill, open = false) => {
    const details = add(parent, "details", {}, add(document.createDocumentFragment(), "summary", { textContent: words }));
    details.addEventListener("toggle", () => fill(details), { once: true });
    details.open = open;
  };

  const fill = async entry => {
    const packed = entry.querySelector(".packed");
    if (!packed) return;
    packed.remove();
    const data = await unpack(packed.textContent), host = document.createElement("div");
    for (const text of data.text) add(host, "p", { innerHTML: text });
    if (data.about) add(host, "p", { className: "about", textContent: data.about });
    for (const src of data.images)
      add(add(host, "a", { href: src }), "img", { src, alt: src.replace(/.*\/|\.png/g, "").replaceAll("_", " "), className: "gallery" });
    for (const [i, [title, rows]] of (data.tables || []).entries())
      folded(host, `${title} (${rows.length - 1} rows)`, details => {
        add(details, "p", { className: "about", textContent: data.sized }).append(saveTable(title, rows));
        table(details, rows);
      }, i === 0 && rows.length <= 60);
    if (data.plots && data.plots.length) {
      add(host, "p", { className: "about", textContent: `Plots: ${data.sized}` });
      const plots = add(host, "div", { className: "plots" });
      for (const [title, svg, numbers] of data.plots) {
        const figure = add(plots, "figure");
        add(figure, "img", { src: URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" })), alt: title });
        if (numbers) figure.append(savePlot(title, numbers));
      }
    }
    if (data.gates && data.gates.length)
      folded(host, `Gates (${data.gates.length})`, details => {
        const list = add(details, "ul");
        for (const [kind, text] of data.gates) add(list, "li", { className: `gate-${kind}`, textContent: `${kind}: ${text}` });
      });
    if (data.record)
      folded(host, "Machine, settings, commit", details => add(details, "pre", { textContent: JSON.stringify(data.record, null, 1) }));
    entry.querySelector("summary").after(host);
  };
  const entries = [...index.querySelectorAll(".entry")];
  for (const entry of entries) entry.addEventListener("toggle", () => fill(entry), { once: true });

  const form = index.querySelector("form");
  const filter = () => {
    const words = form.find.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    for (const entry of entries) {
      const fits = (!form.group.value || entry.dataset.group === form.group.value) && words.every(w => entry.dataset.find.includes(w)) &&
        ["failed", "refused"].every(flag => !form[flag].checked || entry.classList.contains(flag));
      entry.hidden = !fits;
      count += fits;
    }
    for (const section of index.querySelectorAll("section")) section.hidden = !section.querySelector(".entry:not([hidden])");
    form.querySelector("output").textContent = `${count} of ${entries.length} rows`;
  };
  form.addEventListener("input", filter);
  form.addEventListener("submit", event => event.preventDefault());
  for (const link of document.querySelectorAll("[data-show]"))
    link.addEventListener("click", () => { form.reset(); form.group.value = link.dataset.show; filter(); });
  filter();

  // An address such as #fogshop-fig1 opens its row.
  const jump = () => {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target || !target.parentElement.matches(".entry")) return;
    form.reset();
    filter();
    target.parentElement.open = true;
    target.scrollIntoView();
  };
  addEventListener("hashchange", jump);
  jump();
})();
