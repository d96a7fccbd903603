// Fits a figure into a width [px]: panels side by side are stacked where they would be too narrow, every panel with `width`
// gets the available width (squares remain squares), and names at the side and legends are limited. Used by the page and
// by render.mjs, which states the width of the `paper`: panels may be narrower there, and rows are evenly long.
function fitWidth(spec, width, paper) {
  const minPanel = paper ? 90 : 150; // two panels fit into 3.5 inches
  const whole = paper ?? width;
  const legendColumn = 205;
  const axis = paper ? 52 : 62; // y axis with its names and title
  const margin = Math.min(spec.usermeta?.margin_px || axis, Math.max(axis, 0.3 * width));
  const fitNames = (part) => {
    if (Array.isArray(part)) return part.map(fitNames);
    if (part === null || typeof part !== "object") return part;
    const fitted = Object.fromEntries(Object.entries(part).map(([key, value]) => [key, fitNames(value)]));
    if (fitted.legend?.columns && !paper) fitted.legend.columns = Math.max(1, Math.min(fitted.legend.columns, Math.floor(width / legendColumn)));
    // A name above a panel has the panel's width, one at its side less.
    const above = width < 2 * (minPanel + margin) ? width - margin : Math.max(minPanel, 0.22 * width);
    const room = fitted.baseline === "alphabetic" ? above : 0.22 * width;
    if (fitted.type === "text" && fitted.limit) fitted.limit = Math.min(fitted.limit, room);
    if (fitted.axis?.labelLimit) fitted.axis.labelLimit = Math.min(fitted.axis.labelLimit, margin - 20);
    return fitted;
  };
  const fit = (part, room, all) => {
    if (part.concat) {
      const most = Math.max(1, Math.min(paper ? 3 : part.columns || part.concat.length, Math.floor(all / (minPanel + margin))));
      const columns = paper ? Math.ceil(part.concat.length / Math.ceil(part.concat.length / most)) : most;
      return { ...part, columns, concat: part.concat.map((panel) => fit(panel, room / columns, all / columns)) };
    }
    if (part.vconcat) return { ...part, vconcat: part.vconcat.map((panel) => fit(panel, room, all)) };
    const wide = Math.max(paper ? 60 : 120, Math.floor(room - margin));
    if (part.width !== undefined && part.width === part.height) {
      const side = Math.min(wide, part.width);
      return { ...part, width: side, height: side };
    }
    return part.width === undefined ? part : { ...part, width: wide };
  };
  const fitted = fit(fitNames(spec), width, whole);
  if (paper || width >= 2 * legendColumn) return fitted;
  return { ...fitted, config: { ...fitted.config, legend: { ...fitted.config?.legend, columns: 1 } } };
}
