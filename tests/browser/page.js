// What the check asks the page itself; evaluated in the page, its value is the list of faults.
(() => {
  const faults = [];
  const width = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > width) {
    const wide = [...document.querySelectorAll("body *")].filter((e) => e.getBoundingClientRect().right > width + 1);
    const first = wide.find((e) => !e.closest(".wide, pre"));
    faults.push(`the page is ${document.documentElement.scrollWidth} px wide in a window of ${width}: ${first?.outerHTML.slice(0, 80)}`);
  }
  for (const link of document.querySelectorAll("a[href^='#']")) {
    if (!document.getElementById(link.getAttribute("href").slice(1))) faults.push(`${link.outerHTML} leads nowhere`);
  }
  // A clip path of one figure that has the name of another's would cut both.
  const seen = new Set();
  for (const { id } of document.querySelectorAll("[id]")) {
    if (seen.has(id)) faults.push(`the name '${id}' is given twice`);
    seen.add(id);
  }
  // What is drawn next to each other must not lie over each other, nor outside of its figure.
  const figures = [...document.querySelectorAll("figure")];
  for (const figure of figures) {
    const name = figure.querySelector("figcaption")?.textContent ?? "a figure without caption";
    for (const svg of figure.querySelectorAll("svg")) {
      const frame = svg.getBoundingClientRect();
      const texts = [...svg.querySelectorAll("text")].filter((t) => t.textContent.trim() !== "");
      const boxes = texts.map((t) => [t.textContent, t.getBoundingClientRect()]);
      boxes.forEach(([text, a], i) => {
        if (a.left < frame.left - 0.5 || a.right > frame.right + 0.5 || a.top < frame.top - 0.5 || a.bottom > frame.bottom + 0.5) {
          faults.push(`${name}: '${text}' is cut off at the edge`);
        }
        for (const [other, b] of boxes.slice(i + 1)) {
          // Boxes of text have room above and below the letters.
          const slack = 0.22 * Math.min(a.height, b.height);
          const over = Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1
            && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > slack;
          if (over) faults.push(`${name}: '${text}' lies over '${other}'`);
        }
      });
      const sizes = texts.map((t) => parseFloat(getComputedStyle(t).fontSize));
      const smallest = Math.min(...sizes) * (frame.width / svg.viewBox.baseVal.width);
      if (smallest < 6.5) faults.push(`${name}: there are letters of ${smallest.toFixed(1)} px`);
    }
  }
  // Dark on light: at least 4.5 to 1 [WCAG 2.2, 1.4.3]; the page is white where nothing else is set.
  const light = (rgb) => {
    const [r, g, b] = rgb.map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const dim = new Set();
  for (const e of document.querySelectorAll("body *")) {
    if (![...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim() !== "")) continue;
    const style = getComputedStyle(e);
    const colour = e instanceof SVGElement ? style.fill : style.color;
    const rgb = colour.match(/[\d.]+/g)?.slice(0, 3).map(Number);
    if (rgb && 1.05 / (light(rgb) + 0.05) < 4.5) dim.add(`text in ${colour} is hard to read: '${e.textContent.slice(0, 40)}'`);
  }
  return { faults: [...faults, ...dim], figures: figures.length, height: document.documentElement.scrollHeight };
})()
