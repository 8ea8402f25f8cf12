"""Words for what a panel of the gallery shows, and the page results/gallery/README.md."""
import json

from picture import NEAR

LIGHT = {"once": "light scattered once", "all orders": "all orders of scattering", "none": "no scattered light"}


def orders(panel, layer):
    """What light a panel shows, from its method, its settings and the layer: a key of LIGHT."""
    solver = panel["method"].removesuffix("_gpu")
    settings = panel["settings"]
    if layer == "surface":
        return "none"
    if solver == "path_tracer":
        return "once" if 1 in (settings.get("max_order"), settings.get("max_events")) else "all orders"
    if solver == "compensated_ray_marching":
        return "once" if settings.get("multiple") == "none" else "all orders"
    return "once"


def two_digits(value):
    return f"{float(f'{value:.2g}'):g}" if value < 99.5 else f"{value:.0f}"


def percent(share):
    return "below 0.001 %" if share < 1e-5 else f"{two_digits(100 * share)} %"


def duration(seconds):
    """Text of a time; nothing where it was not measured."""
    if seconds is None:
        return ""
    return f"{two_digits(1000 * seconds)} ms" if seconds < 0.995 else f"{two_digits(seconds)} s"


def error_text(frame):
    """Error of a frame, or what the frame is, for a label and for the table of the page."""
    if "error" in frame:
        return f"at most {percent(frame['error'])} (noise)" if frame["hidden"] else percent(frame["error"])
    if "noise" in frame:
        return f"reference, noise {percent(frame['noise'])}" if frame["noise"] else "reference"
    return ""


def toml_value(value):
    return json.dumps(value)  # numbers, texts, true and false, and lists of them are written alike


def film_text(picture):
    return f"{picture['width'] * picture['shrink']}x{picture['height'] * picture['shrink']}"


def film_line(picture, record):
    """The film that was rendered, and the processor that took the times."""
    s, width, height = picture["shrink"], picture["width"], picture["height"]
    film = f"Film: {film_text(picture)} pixels" + (f", each pixel of a panel ({width}x{height}) is the mean of {s}x{s}" if s > 1 else "")
    if not record:
        return f"{film}. The picture holds no errors and times: an earlier script drew it.\n"
    timed = any(frame["seconds"] for row in record["panels"] for frame in row)
    return f"{film}. " + (f"Processor: {record['processor']}.\n" if timed else "Times were not measured yet.\n")


def page_of(pictures, records, once):
    """results/gallery/README.md, from the records in the pictures (None: no such picture). Frames above `once` seconds were timed once."""
    out = f"""# Gallery

One picture for each figure of the papers that shows one. `experiments/gallery.toml` describes the pictures; `scripts/gallery` draws them
and writes this page.

- **Reference.** The first panel of a row is the reference, where there is one. A path-traced reference keeps some noise; the table says
  how much (root mean square, relative to the picture).
- **Error.** The number over a panel is its relative L2 error against the reference. Noise of the reference is subtracted. Errors can be
  larger than in the tables of the papers: larger films have more pixels close to a light. They can be smaller, too: pictures show the
  room or the sky behind smoke, and tables may judge the scattered light alone, under another light, or against another reference.
- **Error map.** The map below a panel shows the difference in luminance from the reference, divided by the mean luminance of the reference.
  Dark violet is no error. All maps of a picture have one scale, which stands below the reference. Grain in a map is noise of the reference.
- **Time.** Time of one frame from nothing: the method prepares everything and renders; reading the scene does not count. It is the
  median of three frames on all threads. A frame of more than {once} seconds was timed once
  (marked *). No time stands where other programs were busy meanwhile, or where none was measured yet. The path
  tracer has a time only where nothing else ran while its picture was drawn; it grows with the samples. Some pictures show a time, too:
  that of the one frame that was drawn.
"""
    for picture, record in zip(pictures, records):
        out += f"\n## {picture['title']}\n\n![{picture['title']}]({picture['name']}.png)\n\n{picture['caption']}\n\n"
        out += "| panel | method | light scattered | settings | error | time |\n|---|---|---|---|---|---|\n"
        for r, scene in enumerate(picture["scene"]):
            for c, panel in enumerate(scene["panel"]):
                frame = record["panels"][r][c] if record else {}
                settings = ", ".join(f"{key} = {toml_value(value)}" for key, value in panel["settings"].items())
                changed = ", ".join(f"{key} = {toml_value(value)}" for key, value in panel["overrides"].items())
                label = f"{scene['label']}: {panel['label']}" if scene["label"] else panel["label"]
                took = duration(frame.get("seconds"))
                took += " *" if took and frame["frames"] == 1 else ""
                cells = [label, panel["method"], orders(panel, scene["layer"]),
                         "; ".join(t for t in (settings, changed) if t) or "defaults", error_text(frame), took]
                out += f"| {' | '.join(cells)} |\n"
        scenes = dict.fromkeys(f"`{s['file'].removeprefix('scenes/')}`" for s in picture["scene"])
        moves = [f"`{key}` from {toml_value(values[0])} to {toml_value(values[-1])}" for key, values in picture["film"].items()]
        if moves:
            count = len(next(iter(picture["film"].values())))
            out += f"\nThe picture is a looping film of {count} frames, {picture['rate']:g} a second: {', '.join(moves)}. "
            out += f"A pixel that changes by {NEAR} or less of 255 levels stays as it is.\n"
        out += f"\nScenes: {', '.join(scenes)}. {film_line(picture, record)}"
    return out.rstrip("\n") + "\n"
