// What is wrong with the layout of a page, in sentences: text that is cut off, that lies on other text or that has too
// little contrast, a page or a part of it that scrolls sideways, a box or a graph that is too small.
() => {
  const found = [], texts = [];
  const seen = (node) => node.checkVisibility({ opacityProperty: true, visibilityProperty: true });
  const name = (node) => `${node.tagName.toLowerCase()}#${node.id}.${node.className} "${(node.textContent ?? "").trim().slice(0, 40)}"`;
  if (document.documentElement.scrollWidth > innerWidth) found.push(`it is ${document.documentElement.scrollWidth} wide`);

  // a frame without what is scrolled out of sight
  const visible = ({ left, right, top, bottom }, node) => {
    for (let at = node.parentElement; at && at !== document.body; at = at.parentElement) {
      if (getComputedStyle(at).overflowY === "visible") continue;
      const frame = at.getBoundingClientRect();
      [top, bottom] = [Math.max(top, frame.top), Math.min(bottom, frame.bottom)];
    }
    return { left, right, top, bottom, node };
  };
  const keep = (frame, node) => {
    const part = visible(frame, node);
    if (part.right - part.left > 1 && part.bottom - part.top > 1) texts.push(part);
  };
  for (const node of document.body.querySelectorAll("*")) {
    if (!seen(node) || node.closest(".unseen, svg, script, .uplot")) continue;
    const { overflowX } = getComputedStyle(node), wide = node.scrollWidth > node.clientWidth + 1;
    if (/hidden|clip/.test(overflowX) && !node.matches("#vitals, .box, .plot, .labels") && wide) found.push(`cut off: ${name(node)}`);
    if (/auto|scroll/.test(overflowX) && wide) found.push(`scrolls sideways: ${name(node)}`);
    const own = [...node.childNodes].filter((each) => each.nodeType === 3 && each.textContent.trim());
    const frame = node.getBoundingClientRect(), control = node.matches("button, input, select, summary");
    if ((own.length || control) && frame.width && (frame.left < -1 || frame.right > innerWidth + 1)) found.push(`outside: ${name(node)}`);
    if (node.matches("input[type=range]") && frame.width < (innerWidth < 500 ? 150 : 80)) found.push(`a slider is ${frame.width} wide: ${node.name}`);
    const range = document.createRange();
    for (const each of own) {
      range.selectNodeContents(each);
      for (const box of range.getClientRects()) keep(box, node);
    }
    if (control) keep(frame, node);
  }

  const above = (node) => Boolean(node.closest("footer, #notes, #caption.open > div")); // may lie on what scrolls below
  texts.forEach((one, place) => {
    for (const other of texts.slice(place + 1)) {
      if (one.node.contains(other.node) || other.node.contains(one.node) || above(one.node) !== above(other.node)) continue;
      const across = Math.min(one.right, other.right) - Math.max(one.left, other.left);
      const up = Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top);
      if (across > 2 && up > 2) found.push(`${name(one.node)} lies on ${name(other.node)}`);
    }
  });

  const parts = (colour) => { // red, green, blue from 0 to 255, and opacity
    const told = (colour.match(/[\d.]+/g) ?? []).map(Number), scale = colour.startsWith("color(srgb") ? 255 : 1;
    return [...told.slice(0, 3).map((part) => scale * part), told[3] ?? 1];
  };
  const linear = (part) => (part / 255 <= 0.03928 ? part / 255 / 12.92 : ((part / 255 + 0.055) / 1.055) ** 2.4);
  const light = ([red, green, blue]) => 0.2126 * linear(red) + 0.7152 * linear(green) + 0.0722 * linear(blue);
  for (const node of new Set(texts.map((each) => each.node))) {
    if (node.disabled || node.matches("input[type=range], input[type=checkbox], .labels *")) continue;
    let at = node, ground = [0, 0, 0, 0];
    for (; at && ground[3] < 1; at = at.parentElement) ground = parts(getComputedStyle(at).backgroundColor);
    const { color, fontSize, fontWeight } = getComputedStyle(node), size = parseFloat(fontSize);
    const [dark, bright] = [light(parts(color)), light(ground)].sort((one, other) => one - other);
    const ratio = (bright + 0.05) / (dark + 0.05), large = size >= 24 || (size >= 18.66 && fontWeight >= 600);
    if (ratio < (large ? 3 : 4.5)) found.push(`contrast ${ratio.toFixed(2)}: ${name(node)}`);
  }

  for (const graph of document.querySelectorAll(".graph .u-over")) {
    const { height } = graph.getBoundingClientRect();
    if (graph.checkVisibility() && height < 110) found.push(`a graph is ${height} high: ${name(graph.closest(".graph"))}`);
  }

  // all graphs are seen at once, but for the name of the last axis
  const graphs = document.querySelector("#graphs"), tools = document.querySelector("#tools");
  const roomy = innerWidth > 1000 && innerHeight > 760 && !document.querySelector(".predicted, #controls [open]");
  if (roomy && graphs.scrollHeight > graphs.clientHeight + 24) found.push(`the graphs are cut at ${graphs.clientHeight} of ${graphs.scrollHeight}`);
  if (innerWidth > 1200 && document.querySelector("#colours").hidden && tools.clientHeight > 1.5 * document.querySelector("#theme").offsetHeight) found.push("the tools take two rows");

  const box = document.querySelector(".box").getBoundingClientRect(), bar = document.querySelector("footer").getBoundingClientRect();
  if (Math.min(box.width, box.height) < 120) found.push(`the box is ${box.width} x ${box.height}`);
  const knob = document.querySelector("#controls input[type=range]")?.getBoundingClientRect();
  if (innerWidth < 500 && knob && (knob.top < box.bottom || knob.bottom > bar.top)) found.push("the knob is not under the box");
  return [...new Set(found)];
}
