// Draws the report's figures when they come into view, in the light or dark scheme, and sorts its tables.
(() => {
  const theme = JSON.parse(document.getElementById("theme").textContent);
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const printing = window.matchMedia("print");
  const views = new Map(); // element -> Vega view

  const config = () => (dark.matches && !printing.matches ? theme.dark : theme.light);
  const specOf = (element) => unpacked(JSON.parse(document.getElementById(element.dataset.spec).textContent));

  async function draw(element) {
    if (element.dataset.drawing) return;
    element.dataset.drawing = "yes";
    const spec = fitWidth(specOf(element), element.clientWidth);
    try {
      views.get(element)?.finalize();
      const result = await vegaEmbed(element, spec, {
        mode: "vega-lite",
        renderer: "svg",
        config: config(),
        actions: { export: { svg: true, png: true }, source: false, compiled: false, editor: false },
        downloadFileName: element.dataset.name,
        i18n: { SVG_ACTION: "Save as SVG", PNG_ACTION: "Save as PNG", CLICK_TO_VIEW_ACTIONS: "Save this figure" },
        tooltip: { theme: dark.matches ? "dark" : "light" },
      });
      views.set(element, result.view);
      element.querySelector("summary")?.setAttribute("aria-label", "Save this figure");
      addSwitches(element, spec, result.view);
      element.dataset.drawn = "yes";
      element.dataset.width = element.clientWidth;
    } catch (error) {
      element.textContent = `This figure could not be drawn: ${error.message}`;
      throw error;
    } finally {
      delete element.dataset.drawing;
    }
  }

  // Buttons for the legend's entries, visible with the focus: they hide and show a series by the keyboard.
  function addSwitches(element, spec, view) {
    element.parentElement.querySelector(".series")?.remove();
    const parameter = spec.params?.find(({ bind }) => bind === "legend");
    if (!parameter) return;
    const names = parameter.value.map((value) => Object.values(value)[0]);
    const store = `${parameter.name}_store`;
    const shown = () => new Set(view.data(store).flatMap(({ values }) => values).flat());
    const entryOf = (name) => [...element.querySelectorAll(".role-legend-label text")].find((label) => label.__data__?.datum?.value === name || label.textContent === name);
    const row = document.createElement("div");
    row.className = "series";
    row.setAttribute("role", "group");
    row.setAttribute("aria-label", "Series of the figure above");
    for (const name of names) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = name;
      button.addEventListener("click", () => entryOf(name)?.dispatchEvent(new MouseEvent("click", { bubbles: true })));
      row.append(button);
    }
    const sync = () => {
      const now = shown();
      [...row.children].forEach((button, i) => button.setAttribute("aria-pressed", now.has(names[i])));
    };
    view.addDataListener(store, sync);
    sync();
    element.after(row);
  }

  const inView = new IntersectionObserver(
    (entries) => {
      for (const { isIntersecting, target } of entries) {
        if (!isIntersecting) continue;
        inView.unobserve(target);
        draw(target);
      }
    },
    { rootMargin: "600px" },
  );
  const figures = [];
  const adopt = (part) => {
    for (const element of part.querySelectorAll("[data-spec]")) {
      figures.push(element);
      inView.observe(element); // figures in closed <details> have no box and are not in view
    }
  };
  adopt(document);

  const shown = (element) => element.clientWidth > 0;
  const redraw = () => [...views.keys()].filter(shown).forEach(draw);
  dark.addEventListener("change", redraw);
  let resized = 0;
  window.addEventListener("resize", () => {
    clearTimeout(resized);
    resized = setTimeout(() => {
      fitTables();
      for (const element of views.keys()) if (shown(element) && Number(element.dataset.width) !== element.clientWidth) draw(element);
    }, 200);
  });
  window.addEventListener("beforeprint", () => {
    for (const element of figures) if (shown(element) && !views.has(element)) draw(element);
  });

  // Keyboard: + and - zoom the time axis of the focused figure, arrows move it, 0 shows all.
  const steps = {
    "+": (low, high) => [low + (high - low) / 4, high - (high - low) / 4],
    "-": (low, high) => [low - (high - low) / 2, high + (high - low) / 2],
    ArrowLeft: (low, high) => [low - (high - low) / 4, high - (high - low) / 4],
    ArrowRight: (low, high) => [low + (high - low) / 4, high + (high - low) / 4],
    0: () => null,
  };
  document.addEventListener("keydown", (event) => {
    const view = views.get(event.target);
    const step = steps[event.key === "=" ? "+" : event.key];
    const signal = event.target.dataset?.zoom;
    if (!view || !step || !signal || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    const now = view.signal(signal) || view.scale(event.target.dataset.scale).domain();
    view.signal(signal, step(now[0], now[1])).runAsync();
  });

  // A click on a column's name sorts by it.
  const number = (text) => Number.parseFloat(text.replace("\u2212", "-"));
  const compare = (a, b) => {
    const [x, y] = [number(a), number(b)];
    if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) && Number.isNaN(y) ? a.localeCompare(b) : Number.isNaN(x) - Number.isNaN(y);
    return x - y;
  };
  for (const table of document.querySelectorAll("table.sortable")) {
    [...table.tHead.rows[0].cells].forEach((header, column) => {
      const name = header.textContent;
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = name;
      header.replaceChildren(button);
      button.addEventListener("click", () => {
        const rising = header.getAttribute("aria-sort") !== "ascending";
        for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
        header.setAttribute("aria-sort", rising ? "ascending" : "descending");
        const body = table.tBodies[0];
        const keyed = [...body.rows].map((row) => ({ row, key: row.cells[column].textContent }));
        const isText = keyed.some(({ key }) => key !== "-" && Number.isNaN(Number(key)));
        const order = isText ? (a, b) => a.localeCompare(b, undefined, { numeric: true }) : compare;
        keyed.sort((a, b) => (rising ? order(a.key, b.key) : order(b.key, a.key)));
        body.append(...keyed.map(({ row }) => row));
      });
    });
  }

  // A table without room for its columns shows each row as a block with its labels.
  const fitTable = (table) => {
    if (table.parentElement.clientWidth === 0) return; // in a closed part
    table.classList.remove("blocks");
    table.classList.toggle("blocks", window.innerWidth < 820 || table.scrollWidth > table.parentElement.clientWidth + 1);
  };
  const fitTables = (part = document) => part.querySelectorAll("table:not(.grid)").forEach(fitTable);
  window.addEventListener("beforeprint", () => document.querySelectorAll("table.blocks").forEach((table) => table.classList.remove("blocks")));
  window.addEventListener("afterprint", () => fitTables());

  // A flight's part may be a compressed block.
  const unfold = async (details) => {
    const block = details.querySelector(":scope > script.block");
    if (!block) return true;
    if (block.dataset.opening) return false;
    block.dataset.opening = "yes";
    details.querySelector(":scope > .warning")?.remove();
    try {
      block.insertAdjacentHTML("afterend", await inflated(block.textContent));
      block.remove();
      adopt(details);
      return true;
    } catch (error) {
      const note = document.createElement("p");
      note.className = "warning";
      note.setAttribute("role", "alert");
      note.textContent = error.message;
      block.before(note);
      return false;
    } finally {
      delete block.dataset.opening;
    }
  };
  const opened = async ({ target }) => target.open && (await unfold(target)) && fitTables(target);
  document.addEventListener("toggle", opened, true); // of every <details>, also those that are unfolded later

  // A link to a flight opens it.
  const openTarget = () => {
    const target = location.hash ? document.getElementById(decodeURIComponent(location.hash.slice(1))) : null;
    if (target?.tagName !== "DETAILS") return;
    target.open = true;
    target.scrollIntoView();
  };
  window.addEventListener("hashchange", openTarget);
  openTarget();
  fitTables();

  window.flightwatt = { views, draw, figures, specOf };
})();
