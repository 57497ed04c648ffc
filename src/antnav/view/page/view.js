// The view: draws what a session sends, and says what a person does. It serves the page and the notebook widget alike;
// a transport is {connect({opened, heard, closed}) -> {send}, linkable}.

const TOOLS = [
  ["wall", "Wall", "w"],
  ["free", "Erase", "e"],
  ["cost", "Cost", "c"],
  ["start", "Start", "s"],
  ["goal", "Goal", "g"],
];
const SPEEDS = [[0.25, "very slow"], [0.5, "slow"], [1, "1 a second"], [2, "2 a second"], [5, "5 a second"], [15, "15 a second"], [60, "60 a second"], [0, "as fast as it can"]];
const KINDS = ["free", "occupied", "unknown", "inflated"];
const ARRIVED = 1, DEAD = 2;
// From here on ants are not seen walking from end to end: dots flow along their walks.
const TOO_FAST = 8;

const HTML = `
<header><h1>antnav view</h1><span class="faint">Ants look for a way: draw a wall and watch.</span>
<span class="connection" role="status"></span></header>
<div class="note" role="alert"></div>
<div class="bar">
<span class="group"><button type="button" class="play">Play</button><button type="button" class="step">Step</button>
<button type="button" class="restart">Restart</button></span>
<label class="group">Speed <select class="speed"></select></label>
<span class="group tools" role="group" aria-label="Pen"></span>
<label class="group">Size <select class="size"><option>1</option><option>3</option><option>5</option><option>9</option></select></label>
<span class="group"><label class="group">Cost <select class="price"><option>1</option><option selected>3</option><option>10</option><option value="0">none</option></select></label></span>
</div>
<main>
<div><div class="panels"></div><p class="scene" role="status"></p><ul class="legend"></ul></div>
<div class="side">
<details open><summary>Algorithm</summary><div class="choices"></div></details>
<details open><summary>Map</summary><div class="form">
<label>Map <select class="maps"></select></label><button type="button" class="load">Load</button>
<label>Rows <input class="rows" type="number" min="2" max="512" value="40"></label>
<label>Columns <input class="cols" type="number" min="2" max="512" value="40"></label>
<label>Corners <select class="rule"></select></label>
<button type="button" class="file wide">Open a file</button><input type="file" multiple>
<span class="range">Or drop a file on the page: PNG, PGM, ROS YAML with its image, MovingAI .map, .txt, .csv, .npy.</span>
</div></details>
<details><summary>Save and share</summary><p class="group">
<button type="button" data-save="map">Map</button><button type="button" data-save="picture">Picture</button>
<button type="button" data-save="film">Film</button><button type="button" data-save="result">Result</button>
<button type="button" data-save="link">Copy link</button></p>
<p class="faint">The link holds map, ends, algorithms, parameters and seed.</p></details>
<details><summary>Keys</summary><ul class="keys"></ul></details>
</div>
</main>`;

const KEYS = [["Space", "play, pause"], ["N", "one iteration"], ["R", "restart"], ["W E C", "wall, erase, cost"], ["S G", "start, goal"], ["Arrows", "move the cursor on the map"], ["Enter", "draw there"], ["Right button", "erase"]];

const LEGEND = [["heat0", "pheromone of the colony from the start"], ["heat1", "pheromone of the other colony"], ["best", "best path so far"], ["plan", "exact plan, mended as you draw"], ["cost", "costs more"], ["dead", "dead end"], ["ant0", "ants, with the last cells of their walks"], ["best", "diamond: the auxiliary cell, where two halves meet"]];

const element = (tag, properties = {}, ...children) => {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
};
const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16));
const number = (value, digits = 2) => (value === null || value === undefined ? "none" : value.toFixed(digits));
// A whole number within the bounds of its field, which shows it then.
const whole = (input) => (input.value = Math.min(Math.max(Math.round(Number(input.value)) || 0, input.min), input.max));
const ARRAYS = { uint8: Uint8Array, uint16: Uint16Array, float32: Float32Array };

// Colours of cells as whole pixels: those of walls, and of what can be walked on by kind (free, unknown), price (four
// steps) and pheromone of both colonies (32 steps each).
const shadesOf = (colour) => {
  const [kinds, heat, cost] = [KINDS, ["heat0", "heat1"], ["cost"]].map((names) => names.map((name) => rgb(colour(name))));
  const mix = (one, other, share) => one.map((value, i) => value + (other[i] - value) * share);
  const pixel = ([r, g, b]) => new Uint32Array(new Uint8Array([r, g, b, 255]).buffer)[0];
  const shades = new Uint32Array(3 << 12);
  for (const kind of [0, 2])
    for (let at = 0; at < 1 << 12; at++) {
      const price = at >> 10, dear = price ? mix(kinds[kind], cost[0], 0.2 + 0.18 * price) : kinds[kind];
      shades[(kind << 12) | at] = pixel(mix(mix(dear, heat[0], (0.8 * ((at >> 5) & 31)) / 31), heat[1], (0.8 * (at & 31)) / 31));
    }
  return { shades, fixed: kinds.map(pixel) };
};

// A packet: length of the header, header, arrays at multiples of eight bytes.
const unpacked = (buffer, offset = 0) => {
  const length = new DataView(buffer, offset).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, offset + 4, length)));
  let at = offset + 4 + length;
  for (const [name, kind, size] of header.blobs) {
    const type = ARRAYS[kind];
    header[name] = new type(buffer, at, size);
    at += Math.ceil((size * type.BYTES_PER_ELEMENT) / 8) * 8;
  }
  return header;
};

// Cells on the line between two, both included.
const between = ([r0, c0], [r1, c1]) => {
  const count = Math.max(Math.abs(r1 - r0), Math.abs(c1 - c0), 1), cells = [[r0, c0]];
  for (let i = 1; i <= count; i++) {
    const row = Math.round(r0 + ((r1 - r0) * i) / count), col = Math.round(c0 + ((c1 - c0) * i) / count);
    const [lastRow, lastCol] = cells.at(-1);
    if (row !== lastRow && col !== lastCol) cells.push([row, lastCol]); // no gap that a diagonal move could pass
    cells.push([row, col]);
  }
  return cells;
};

class Panel {
  constructor(view, index) {
    this.view = view;
    this.index = index;
    this.title = element("h2");
    this.canvas = element("canvas", { className: "map", tabIndex: 0 });
    this.canvas.setAttribute("role", "img");
    this.words = element("div", { className: "words" });
    this.words.setAttribute("aria-live", "off");
    this.chart = element("canvas", { className: "chart" });
    this.chart.setAttribute("role", "img");
    this.root = element("section", { className: "panel" }, this.title, this.canvas, this.words, this.chart);
    this.clear();
  }

  clear(name = "") {
    this.title.textContent = name;
    this.chart.setAttribute("aria-label", `Lengths by iteration of ${name}: none yet`);
    this.explain();
    this.rows = [];
    this.turns = [];
    this.frame = null;
    this.stale = true;
  }

  // Why nothing walks, where nothing can.
  explain() {
    this.words.replaceChildren(...[this.view.scene?.words].filter(Boolean).map((text) => element("p", { textContent: text })));
  }

  take(frame) {
    if (frame.first === 0) this.rows = [];
    if (!this.frame || this.frame.stage !== frame.stage) this.turns.push(frame.first);
    this.rows.push(...frame.rows);
    this.frame = frame;
    this.began = performance.now();
    let at = 0;
    this.walks = frame.ants.map(([side, fate, count]) => {
      const cells = frame.walks.subarray(2 * at, 2 * (at + count));
      at += count;
      return { side, fate, count, cells };
    });
    this.longest = Math.max(2, ...this.walks.map((walk) => walk.count));
    this.stale = true;
    this.words.replaceChildren(...frame.words.map((text) => element("p", { textContent: text })));
    this.drawChart();
  }

  resize() {
    const { scene } = this.view;
    if (!scene) return;
    const width = this.canvas.clientWidth, ratio = Math.min(devicePixelRatio || 1, 3);
    const wide = Math.min(width * ratio, 3840, (16384 * scene.cols) / scene.rows);
    this.canvas.width = Math.max(1, Math.round(wide));
    this.canvas.height = Math.max(1, Math.round((wide * scene.rows) / scene.cols));
    for (const canvas of [this.chart]) {
      canvas.width = Math.max(64, Math.round(canvas.clientWidth * ratio));
      canvas.height = Math.max(32, Math.round(canvas.clientHeight * ratio));
    }
    this.stale = true;
    this.drawChart();
  }

  // The map with prices and pheromone, a pixel a cell.
  paint() {
    const { scene, palette } = this.view;
    const { rows, cols, cells, prices } = scene;
    if (!this.small || this.small.width !== cols || this.small.height !== rows) {
      this.small = new OffscreenCanvas(cols, rows);
      this.image = new ImageData(cols, rows);
    }
    const pixels = new Uint32Array(this.image.data.buffer), none = new Uint8Array(0), { shades, fixed } = palette;
    const [heat0, heat1] = ["heat0", "heat1"].map((name) => (this.frame?.[name].length === cells.length ? this.frame[name] : none));
    for (let i = 0; i < cells.length; i++) {
      const kind = cells[i];
      if (kind === 1 || kind === 3) pixels[i] = fixed[kind];
      else pixels[i] = shades[(kind << 12) | ((prices[i] >> 6) << 10) | ((heat0[i] >> 3) << 5) | (heat1[i] >> 3)];
    }
    this.small.getContext("2d").putImageData(this.image, 0, 0);
    this.stale = false;
  }

  // Whether it moves by itself.
  draw(now) {
    const { scene, palette, speed, playing, cursor } = this.view;
    if (this.stale) this.paint();
    const { width, height } = this.canvas, cell = width / scene.cols, pen = this.canvas.getContext("2d");
    pen.imageSmoothingEnabled = cell < 1;
    pen.drawImage(this.small, 0, 0, width, height);
    if (cell >= 7) {
      pen.beginPath();
      for (let col = 1; col < scene.cols; col++) { pen.moveTo(col * cell, 0); pen.lineTo(col * cell, height); }
      for (let row = 1; row < scene.rows; row++) { pen.moveTo(0, row * cell); pen.lineTo(width, row * cell); }
      pen.strokeStyle = palette.grid;
      pen.lineWidth = 1;
      pen.stroke();
    }
    const thick = Math.max(2, Math.min(cell * 0.28, width / 90));
    this.line(pen, scene.plan, 0, scene.plan.length / 2, cell, palette.names.plan, thick * 0.7, [thick, thick]);
    const moving = this.drawAnts(pen, cell, now, speed, playing);
    if (this.frame) {
      let at = 0;
      for (const count of this.frame.bests) {
        this.line(pen, this.frame.best, at, count, cell, palette.names.halo, thick * 1.9);
        this.line(pen, this.frame.best, at, count, cell, palette.names.best, thick);
        at += count;
      }
      if (this.frame.auxiliary) this.mark(pen, this.frame.auxiliary, cell, "diamond", "auxiliary cell");
    }
    this.mark(pen, scene.start, cell, "start", "S");
    this.mark(pen, scene.goal, cell, "goal", "G");
    if (cursor && document.activeElement === this.canvas) {
      pen.strokeStyle = palette.names.best;
      pen.lineWidth = Math.max(2, cell / 8);
      pen.strokeRect(cursor[1] * cell, cursor[0] * cell, cell, cell);
    }
    return moving;
  }

  line(pen, cells, from, count, cell, colour, thick, dash = []) {
    if (count < 2) return;
    pen.beginPath();
    for (let i = from; i < from + count; i++) pen.lineTo((cells[2 * i + 1] + 0.5) * cell, (cells[2 * i] + 0.5) * cell);
    pen.setLineDash(dash);
    pen.lineJoin = pen.lineCap = "round";
    pen.strokeStyle = colour;
    pen.lineWidth = thick;
    pen.stroke();
    pen.setLineDash([]);
  }

  drawAnts(pen, cell, now, speed, playing) {
    const { frame, walks } = this;
    if (!frame || !walks?.length || frame.done) return false;
    const { palette } = this.view, size = Math.max(1.6, Math.min(cell * 0.2, this.canvas.width / 150));
    const fast = speed === 0 || speed > TOO_FAST;
    // Every ant makes as many moves in a moment; the longest walk is done shortly before the next iteration.
    const lasts = fast ? 1200 : 900 / (speed || 1), age = Math.min(1, (now - this.began) / lasts);
    const flow = (now / 1200) % 1;
    for (const side of [0, 1]) {
      pen.fillStyle = pen.strokeStyle = palette.names[`ant${side}`];
      pen.lineWidth = size * 0.55;
      const tails = new Path2D(), heads = new Path2D();
      for (const walk of walks) {
        if (walk.side !== side) continue;
        const place = fast ? flow * walk.count : Math.min(age * this.longest, walk.count - 1);
        const head = Math.min(Math.floor(place), walk.count - 1), next = Math.min(head + 1, walk.count - 1), rest = place - head;
        const row = walk.cells[2 * head] + (walk.cells[2 * next] - walk.cells[2 * head]) * rest;
        const col = walk.cells[2 * head + 1] + (walk.cells[2 * next + 1] - walk.cells[2 * head + 1]) * rest;
        const x = (col + 0.5) * cell, y = (row + 0.5) * cell;
        for (let i = Math.max(0, head - 5); i <= head; i++) {
          const px = (walk.cells[2 * i + 1] + 0.5) * cell, py = (walk.cells[2 * i] + 0.5) * cell;
          if (i === Math.max(0, head - 5)) tails.moveTo(px, py);
          else tails.lineTo(px, py);
        }
        tails.lineTo(x, y);
        heads.moveTo(x + size, y);
        heads.arc(x, y, size, 0, 2 * Math.PI);
      }
      pen.stroke(tails);
      pen.fill(heads);
    }
    if (fast || age > 0.6) {
      pen.strokeStyle = palette.names.dead;
      pen.lineWidth = Math.max(1.5, size * 0.6);
      pen.beginPath();
      for (let i = 0; i < frame.dead.length; i += 2) {
        const x = (frame.dead[i + 1] + 0.5) * cell, y = (frame.dead[i] + 0.5) * cell, arm = size * 1.3;
        pen.moveTo(x - arm, y - arm); pen.lineTo(x + arm, y + arm);
        pen.moveTo(x + arm, y - arm); pen.lineTo(x - arm, y + arm);
      }
      pen.stroke();
    }
    return fast ? playing : age < 1;
  }

  mark(pen, [row, col], cell, shape, text) {
    const { palette } = this.view, x = (col + 0.5) * cell, y = (row + 0.5) * cell;
    const size = Math.max(7, Math.min(cell * 0.48, this.canvas.width / 40));
    pen.beginPath();
    if (shape === "diamond") {
      for (const [dx, dy] of [[0, -1], [1, 0], [0, 1], [-1, 0]]) pen.lineTo(x + dx * size, y + dy * size);
      pen.closePath();
    } else if (shape === "start") pen.arc(x, y, size, 0, 2 * Math.PI);
    else pen.rect(x - size, y - size, 2 * size, 2 * size);
    pen.fillStyle = palette.names.paper;
    pen.strokeStyle = shape === "diamond" ? palette.names.best : palette.names.ink;
    pen.lineWidth = Math.max(2, size / 5);
    pen.fill();
    pen.stroke();
    pen.fillStyle = palette.names.ink;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    if (shape === "diamond") {
      pen.font = `600 ${Math.max(11, size * 0.9)}px system-ui, sans-serif`;
      const wide = pen.measureText(text).width, left = Math.min(Math.max(x, wide / 2 + 4), this.canvas.width - wide / 2 - 4);
      const below = y + size * 2 < this.canvas.height - size ? y + size * 2 : y - size * 2;
      pen.lineWidth = 4;
      pen.strokeStyle = palette.names.halo;
      pen.strokeText(text, left, below);
      pen.fillText(text, left, below);
    } else {
      pen.font = `700 ${size * 1.25}px system-ui, sans-serif`;
      pen.fillText(text, x, y + size * 0.08);
    }
  }

  // Best and mean length by iteration, the optimum, and below it how many ants were lost.
  drawChart() {
    const { scene, palette } = this.view, pen = this.chart.getContext("2d"), { width, height } = this.chart;
    pen.clearRect(0, 0, width, height);
    if (!scene || !palette || !this.rows.length) return;
    const scale = Math.max(1, Math.round(width / Math.max(this.chart.clientWidth, 1))), font = 12 * scale;
    const known = this.rows.flatMap(([best, mean]) => [best, mean]).filter((value) => value !== null);
    const optimum = scene.optimum;
    if (optimum !== null) known.push(optimum);
    const least = Math.min(...known), most = Math.max(...known, least + 1e-9);
    const left = 52 * scale, right = width - 6 * scale, top = 8 * scale, floor = height * 0.66;
    const x = (i) => left + ((right - left) * (i + 0.5)) / Math.max(this.rows.length, 10);
    const y = (value) => floor - ((floor - top) * (value - least)) / (most - least);
    pen.font = `${font}px system-ui, sans-serif`;
    pen.fillStyle = palette.names.faint;
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    if (known.length) {
      pen.fillText(number(most, 1), left - 6 * scale, top + 2 * scale);
      pen.fillText(number(least, 1), left - 6 * scale, floor);
    }
    if (optimum !== null) this.stroke(pen, [[left, y(optimum)], [right, y(optimum)]], palette.names.plan, scale, [5 * scale, 4 * scale]);
    for (const turn of this.turns.filter((turn) => turn > 0)) this.stroke(pen, [[x(turn) - 2, top], [x(turn) - 2, floor]], palette.names.line, scale);
    for (const [column, colour, thick] of [[1, palette.names.faint, 1], [0, palette.names.best, 2]]) {
      const points = this.rows.map((row, i) => (row[column] === null ? null : [x(i), y(row[column])])).filter(Boolean);
      this.stroke(pen, points, colour, thick * scale);
    }
    pen.textAlign = "left";
    const labels = [["best", palette.names.best], ["mean", palette.names.faint], ["optimum", palette.names.plan]];
    labels.reduce((at, [text, colour]) => {
      pen.fillStyle = colour;
      pen.fillRect(at, floor + 8 * scale, 12 * scale, 2 * scale);
      pen.fillStyle = palette.names.ink;
      pen.fillText(text, at + 16 * scale, floor + 9 * scale);
      return at + pen.measureText(text).width + 30 * scale;
    }, left);
    pen.textAlign = "right";
    pen.fillStyle = palette.names.faint;
    const lost = Math.max(1, ...this.rows.map((row) => row[3])), base = floor + 18 * scale, deep = height - base - 2 * scale;
    pen.fillText(`lost, ${lost}`, left - 6 * scale, base + deep / 2);
    pen.fillStyle = palette.names.dead;
    const wide = Math.max(1, (x(1) - x(0)) * 0.7);
    this.rows.forEach((row, i) => pen.fillRect(x(i) - wide / 2, base + deep * (1 - row[3] / lost), wide, (deep * row[3]) / lost));
    const last = this.rows.at(-1);
    this.chart.setAttribute("aria-label", `Lengths by iteration: best ${number(last[0])}, mean ${number(last[1])}, optimum ${number(optimum)}; ${last[3]} ants lost in the last one`);
  }

  stroke(pen, points, colour, thick, dash = []) {
    pen.beginPath();
    for (const [px, py] of points) pen.lineTo(px, py);
    pen.setLineDash(dash);
    pen.strokeStyle = colour;
    pen.lineWidth = thick;
    pen.stroke();
    pen.setLineDash([]);
  }

  cellAt(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect(), { scene } = this.view;
    return [Math.floor(((event.clientY - top) / height) * scene.rows), Math.floor(((event.clientX - left) / width) * scene.cols)];
  }
}

class View {
  constructor(root, transport) {
    this.root = root;
    this.transport = transport;
    this.root.classList.add("antnav");
    this.root.innerHTML = HTML;
    this.find = (name) => this.root.querySelector(name);
    this.panels = [];
    this.scene = null;
    this.speed = 2;
    this.playing = false;
    this.tool = "wall";
    this.cursor = null;
    this.stroke = null;
    this.owed = 0;
    this.frames = this.packets = 0;
    this.build();
    this.connect();
  }

  build() {
    this.find(".speed").append(...SPEEDS.map(([value, text]) => element("option", { value, textContent: text })));
    for (const [name, text] of TOOLS) {
      const button = element("button", { type: "button", textContent: text, onclick: () => this.choose(name) });
      button.dataset.tool = name;
      this.find(".tools").append(button);
    }
    this.choose("wall");
    for (const [key, text] of KEYS) this.find(".keys").append(element("li", {}, element("kbd", { textContent: key }), ` ${text}`));
    for (const [name, text] of LEGEND) {
      const patch = element("i");
      patch.style.background = `var(--${name})`;
      this.find(".legend").append(element("li", {}, patch, text));
    }
    this.find(".play").onclick = (event) => {
      this.say({ do: this.playing ? "pause" : "play" });
      if (!this.playing) event.target.textContent = "Pause"; // at once; the server's word follows
    };
    this.find(".step").onclick = () => this.say({ do: "step" });
    this.find(".restart").onclick = () => this.say({ do: "restart" });
    this.find(".speed").onchange = (event) => {
      this.speed = Number(event.target.value);
      this.say({ do: "speed", speed: this.speed });
      this.share();
    };
    this.find(".load").onclick = () => {
      const [name, drawn] = this.find(".maps").value.split("|");
      this.say({ do: "load", name, drawn: drawn !== undefined, rows: whole(this.find(".rows")), cols: whole(this.find(".cols")), seed: this.seed });
    };
    this.find(".rule").onchange = () => this.sendChoices();
    const input = this.find("input[type=file]");
    this.find(".file").onclick = () => input.click();
    input.onchange = () => this.drop(input.files).finally(() => (input.value = ""));
    for (const button of this.root.querySelectorAll("[data-save]")) button.onclick = () => this.save(button.dataset.save);
    this.root.addEventListener("dragover", (event) => {
      event.preventDefault();
      this.root.classList.add("dropping");
    });
    this.root.addEventListener("dragleave", () => this.root.classList.remove("dropping"));
    this.root.addEventListener("drop", (event) => {
      event.preventDefault();
      this.root.classList.remove("dropping");
      this.drop(event.dataTransfer.files);
    });
    this.root.addEventListener("keydown", (event) => this.key(event));
    // In a page of its own keys count wherever the focus is; in a notebook only inside the view.
    if (this.transport.linkable) addEventListener("hashchange", () => this.open());
    if (this.transport.linkable) document.addEventListener("keydown", (event) => event.target === document.body && this.key(event));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.recolour());
    new ResizeObserver(() => this.fit()).observe(this.find(".panels"));
    this.recolour();
  }

  recolour() {
    const styles = getComputedStyle(this.root), colour = (name) => styles.getPropertyValue(`--${name}`).trim();
    const names = Object.fromEntries(["ink", "faint", "paper", "line", "best", "plan", "dead", "halo", "ant0", "ant1"].map((name) => [name, colour(name)]));
    this.palette = { names, grid: colour("grid"), ...shadesOf(colour) };
    for (const panel of this.panels) {
      panel.stale = true;
      panel.drawChart();
    }
    this.redraw();
  }

  connect() {
    this.find(".connection").textContent = "connecting";
    const opened = () => {
      this.find(".connection").textContent = "";
      this.tries = 0;
      this.open();
    };
    const closed = (code) => {
      this.playing = false;
      this.find(".connection").textContent = code === 1013 ? "the server is full" : "the server is gone; trying again";
      this.tries = (this.tries ?? 0) + 1;
      if (code !== 1013) setTimeout(() => this.connect(), Math.min(500 * this.tries, 5000));
    };
    this.link = this.transport.connect({ opened, heard: (data) => this.hear(data), closed });
  }

  // Show what the address holds, and in the form what the session has.
  open() {
    this.renewed = true;
    const link = this.transport.linkable ? (location.hash.match(/^#v=([\w-]+)$/)?.[1] ?? "") : "";
    this.say({ do: "open", link });
  }

  say(message) {
    const sent = this.link.send(JSON.stringify(message));
    if (sent === false || this.waiting || (message.do === "ack" && !this.playing)) return;
    this.waiting = setTimeout(() => {
      this.find(".connection").textContent = "working (what an algorithm needs is compiled once per machine)";
    }, 1500 + (this.speed ? 1000 / this.speed : 0));
  }

  hear(data) {
    if (this.waiting) {
      clearTimeout(this.waiting);
      this.waiting = null;
      const connection = this.find(".connection");
      if (connection.textContent.startsWith("working")) connection.textContent = "";
    }
    if (typeof data === "string") this.told(JSON.parse(data));
    else this.told(unpacked(data));
  }

  told(message) {
    switch (message.is) {
      case "menu": return this.offer(message);
      case "scene": return this.see(message);
      case "frame": {
        this.panels[message.panel]?.take(message);
        this.packets += 1;
        return this.redraw();
      }
      case "began": {
        this.setPanels(message.panels.length);
        this.panels.forEach((panel, i) => panel.clear(message.panels[i]));
        return this.redraw();
      }
      case "state": {
        this.playing = message.playing;
        this.find(".play").textContent = message.playing ? "Pause" : message.done ? "Again" : "Play";
        this.owed += 1;
        return this.redraw();
      }
      case "note": {
        this.find(".note").textContent = `${message.given}: ${message.rule}; ${message.remedy}.`;
        clearTimeout(this.fading);
        this.fading = setTimeout(() => (this.find(".note").textContent = ""), 8000);
        return undefined;
      }
      case "link": {
        const url = `${location.href.split("#")[0]}#v=${message.link}`;
        if (this.transport.linkable && message.link.length < 200000) history.replaceState(null, "", url);
        if (this.copying) navigator.clipboard?.writeText(url).then(() => this.tell("Link copied"), () => this.tell("The link is in the address bar"));
        this.copying = false;
        return undefined;
      }
      case "file": return this.download(message.name, new Blob([message.content]));
    }
    return undefined;
  }

  tell(text) {
    this.find(".connection").textContent = text;
    setTimeout(() => (this.find(".connection").textContent = ""), 4000);
  }

  offer(menu) {
    this.menu = menu;
    const maps = this.find(".maps");
    maps.replaceChildren(
      ...menu.maps.map((name) => element("option", { value: name, textContent: name })),
      element("option", { value: "empty", textContent: "empty" }),
      ...menu.generators.map((name) => element("option", { value: `${name}|drawn`, textContent: `${name} (drawn anew)` })),
    );
    this.find(".rule").replaceChildren(...menu.corner_rules.map((name) => element("option", { value: name, textContent: name })));
  }

  see(scene) {
    const other = !this.scene || this.scene.rows !== scene.rows || this.scene.cols !== scene.cols;
    this.scene = scene;
    this.root.style.setProperty("--aspect", scene.cols / scene.rows);
    this.find(".rule").value = scene.corner_rule;
    const maps = this.find(".maps"), known = [...maps.options].some((option) => option.value === scene.name);
    this.find(".own")?.remove();
    if (!known) maps.prepend(element("option", { className: "own", value: "", textContent: scene.name || "a map of your own", disabled: true }));
    maps.value = known ? scene.name : "";
    if (other) [this.find(".rows").value, this.find(".cols").value] = [scene.rows, scene.cols];
    this.speed = scene.speed;
    this.find(".speed").value = String(scene.speed);
    const plan = scene.mended;
    const shortest = scene.prices.length ? `Cheapest way costs ${number(scene.optimum)}` : `Shortest way: ${number(scene.optimum)} cells`;
    this.find(".scene").textContent = scene.words || `${shortest}. Exact plan: ${plan.did}, ${plan.milliseconds.toFixed(2)} ms.`;
    if (this.renewed) this.setChoices(scene);
    this.renewed = false;
    this.setPanels(scene.panels.length);
    for (const panel of this.panels) {
      panel.stale = true;
      if (scene.words) panel.explain();
      panel.canvas.setAttribute("aria-label", `Map ${scene.name}, ${scene.rows} x ${scene.cols} cells, with the ants of ${panel.title.textContent}. ${this.find(".scene").textContent}`);
      if (other) panel.small = null;
    }
    if (!this.cursor || other) this.cursor = [...scene.start];
    if (other) this.fit();
    this.redraw();
    this.share();
  }

  setPanels(count) {
    while (this.panels.length > count) this.panels.pop().root.remove();
    while (this.panels.length < count) {
      const panel = new Panel(this, this.panels.length);
      this.listen(panel);
      this.panels.push(panel);
      this.find(".panels").append(panel.root);
      this.fit();
    }
  }

  fit() {
    for (const panel of this.panels) panel.resize();
    this.redraw();
  }

  redraw() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame((now) => {
      this.asked = false;
      this.flush();
      if (!this.scene) return;
      let moving = false;
      for (const panel of this.panels) if (panel.canvas.width && this.scene) moving = panel.draw(now) || moving;
      this.frames += 1;
      for (; this.owed > 0; this.owed--) this.say({ do: "ack" });
      if (moving) this.redraw();
    });
  }

  // Parameters as a form: those that a preset has, with their ranges.
  setChoices(scene) {
    this.chosen = scene.panels.map(({ algorithm, parameters }) => ({ algorithm, parameters: { ...parameters } }));
    this.seed = scene.seed;
    this.showChoices();
  }

  showChoices() {
    const place = this.find(".choices");
    const seed = element("input", { type: "number", min: 0, max: Number.MAX_SAFE_INTEGER, step: 1, value: this.seed, className: "seed", onchange: (event) => { this.seed = whole(event.target); this.sendChoices(); } });
    const compare = element("input", { type: "checkbox", checked: this.chosen.length > 1, className: "compare", onchange: (event) => {
      if (event.target.checked) this.chosen.push({ algorithm: this.chosen[0].algorithm === "npaco" ? "paco" : "npaco", parameters: {} });
      else this.chosen.pop();
      this.sendChoices();
      this.showChoices();
    } });
    place.replaceChildren(
      element("div", { className: "form" }, element("label", {}, "Seed ", seed), element("label", {}, "Two side by side ", compare)),
      ...(this.chosen.length > 1 ? [element("p", { className: "faint", textContent: "Same seed and map. Efforts differ where one has more colonies or ants: PACO's two have as many ants each as NPACO's one." })] : []),
      ...this.chosen.map((one, index) => this.formOf(one, index)),
    );
  }

  formOf(one, index) {
    const about = this.menu.algorithms.find((entry) => entry.name === one.algorithm);
    const select = element("select", { className: "algorithm", onchange: (event) => {
      this.chosen[index] = { algorithm: event.target.value, parameters: {} };
      this.sendChoices();
      this.showChoices();
    } }, ...this.menu.algorithms.map((entry) => element("option", { value: entry.name, textContent: entry.name })));
    select.value = one.algorithm;
    select.ariaLabel = `Algorithm ${index + 1}`;
    const rows = about.parameters.map((known) => this.rowOf(one, known));
    return element("div", {}, element("p", {}, select), element("p", { className: "faint", textContent: `${about.about.replaceAll("`", "")} Certainty: ${about.certainty ?? "exact"}.` }),
      element("div", { className: "form" }, ...rows.slice(0, 6).flat()),
      ...(rows.length > 6 ? [element("details", {}, element("summary", { textContent: "More parameters" }), element("div", { className: "form" }, ...rows.slice(6).flat()))] : []));
  }

  rowOf(one, known) {
    const value = one.parameters[known.name] ?? known.value;
    const set = (given) => {
      if (given === known.value) delete one.parameters[known.name];
      else one.parameters[known.name] = given;
      this.sendChoices();
    };
    let input;
    if (known.kind === "choice") {
      input = element("select", { onchange: (event) => set(event.target.value) }, ...known.choices.map((name) => element("option", { value: name, textContent: name })));
      input.value = value;
    } else if (known.kind === "truth") input = element("input", { type: "checkbox", checked: value, onchange: (event) => set(event.target.checked) });
    else input = element("input", { type: "number", value: value ?? "", min: known.least, max: known.most, step: known.kind === "whole" ? 1 : "any", onchange: (event) => set(event.target.value === "" ? null : Number(event.target.value)) });
    input.dataset.parameter = known.name;
    const label = element("label", { textContent: known.symbol ? `${known.name} (${known.symbol})` : known.name });
    label.htmlFor = input.id = `antnav-${this.chosen.indexOf(one)}-${known.name}`;
    const sane = known.sane && known.kind !== "choice" && known.kind !== "truth" ? `; most maps: ${known.sane[0]} to ${known.sane[1]}` : "";
    return [label, input, element("span", { className: "range", textContent: `${known.range}${known.kind === "choice" ? "" : sane}` })];
  }

  sendChoices() {
    this.say({ do: "choose", panels: this.chosen, seed: this.seed, corner_rule: this.find(".rule").value || "allow" });
    this.share();
  }

  choose(tool) {
    this.tool = tool;
    for (const button of this.root.querySelectorAll("[data-tool]")) button.setAttribute("aria-pressed", String(button.dataset.tool === tool));
  }

  // Pens: mouse, touch and stylus alike. What lies under the pen decides whether an end is dragged.
  listen(panel) {
    const { canvas } = panel;
    canvas.addEventListener("pointerdown", (event) => {
      if (!this.scene) return;
      event.preventDefault();
      canvas.focus();
      canvas.setPointerCapture(event.pointerId);
      const cell = panel.cellAt(event), same = ([row, col]) => Math.max(Math.abs(row - cell[0]), Math.abs(col - cell[1])) <= this.grip();
      let tool = event.button === 2 ? "free" : this.tool;
      if (!["start", "goal"].includes(tool)) tool = same(this.scene.start) ? "start" : same(this.scene.goal) ? "goal" : tool;
      this.stroke = { tool, last: cell };
      this.apply(tool, [cell]);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!this.stroke) return;
      const cell = panel.cellAt(event), { last, tool } = this.stroke;
      if (cell[0] === last[0] && cell[1] === last[1]) return;
      this.apply(tool, between(last, cell).slice(1));
      this.stroke.last = cell;
    });
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => { this.stroke = null; this.flush(); });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("blur", () => this.redraw());
    canvas.addEventListener("focus", () => this.redraw());
  }

  grip() {
    return Math.floor(Math.max(this.scene.rows, this.scene.cols) / 90);
  }

  inside([row, col]) {
    return row >= 0 && col >= 0 && row < this.scene.rows && col < this.scene.cols;
  }

  // Show at once what is drawn, and say it with the next frame.
  apply(tool, cells) {
    if (tool === "start" || tool === "goal") {
      const cell = cells.at(-1);
      if (!this.inside(cell)) return;
      this.scene[tool] = cell;
      this.moved = { ...this.moved, [tool]: cell };
    } else {
      const reach = Math.floor(Number(this.find(".size").value) / 2), price = Number(this.find(".price").value);
      this.inked ??= { kind: tool, cost: price, cells: new Map() };
      if (this.inked.kind !== tool) this.flush();
      this.inked ??= { kind: tool, cost: price, cells: new Map() };
      for (const [row, col] of cells)
        for (let r = row - reach; r <= row + reach; r++)
          for (let c = col - reach; c <= col + reach; c++)
            if (this.inside([r, c])) {
              const at = r * this.scene.cols + c;
              this.inked.cells.set(at, [r, c]);
              if (tool !== "cost") this.scene.cells[at] = tool === "wall" ? 1 : 0;
            }
    }
    for (const panel of this.panels) panel.stale = true;
    this.redraw();
  }

  flush() {
    if (this.inked?.cells.size) this.say({ do: "draw", kind: this.inked.kind, cost: this.inked.cost, cells: [...this.inked.cells.values()] });
    this.inked = null;
    if (this.moved) this.say({ do: "ends", ...this.moved });
    this.moved = null;
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || ["INPUT", "SELECT", "TEXTAREA"].includes(event.target.tagName)) return;
    const onMap = event.target.classList?.contains("map"), key = event.key.toLowerCase();
    const arrows = { arrowup: [-1, 0], arrowdown: [1, 0], arrowleft: [0, -1], arrowright: [0, 1] };
    const tool = TOOLS.find(([, , letter]) => letter === key);
    if (key === " " && event.target.tagName !== "BUTTON" && event.target.tagName !== "SUMMARY") this.find(".play").click();
    else if (key === "n") this.find(".step").click();
    else if (key === "r") this.find(".restart").click();
    else if (tool) this.choose(tool[0]);
    else if (onMap && arrows[key]) {
      const next = [this.cursor[0] + arrows[key][0], this.cursor[1] + arrows[key][1]];
      if (this.inside(next)) this.cursor = next;
      if (event.shiftKey) this.apply(this.tool, [this.cursor]);
      this.redraw();
    } else if (onMap && key === "enter") this.apply(this.tool, [this.cursor]);
    else return;
    event.preventDefault();
  }

  async drop(list) {
    const given = [...list].slice(0, 4);
    if (!given.length) return;
    if (given.reduce((sum, file) => sum + file.size, 0) > this.menu.most_bytes) {
      this.told({ is: "note", given: given[0].name, rule: `a map file has at most ${this.menu.most_bytes / 1e6} MB`, remedy: "crop the map" });
      return;
    }
    let contents;
    try {
      contents = await Promise.all(given.map((file) => file.arrayBuffer()));
    } catch {
      this.told({ is: "note", given: given[0].name, rule: "the browser cannot read it", remedy: "drop files, no folders" });
      return;
    }
    const header = new TextEncoder().encode(JSON.stringify({ do: "drop", files: given.map((file, i) => [file.name, contents[i].byteLength]) }));
    const message = new Uint8Array(4 + header.length + contents.reduce((sum, content) => sum + content.byteLength, 0));
    new DataView(message.buffer).setUint32(0, header.length, true);
    message.set(header, 4);
    let at = 4 + header.length;
    for (const content of contents) {
      message.set(new Uint8Array(content), at);
      at += content.byteLength;
    }
    this.link.send(message);
  }

  save(what) {
    if (what === "picture") this.panels[0].canvas.toBlob((blob) => this.download("antnav.png", blob));
    else if (what === "film") this.film();
    else {
      this.copying = what === "link";
      this.say({ do: "save", what, panel: 0 });
    }
  }

  film() {
    const button = this.find("[data-save=film]");
    if (this.recorder) {
      this.recorder.stop();
      return;
    }
    const parts = [], recorder = new MediaRecorder(this.panels[0].canvas.captureStream(30), { mimeType: "video/webm" });
    recorder.ondataavailable = (event) => parts.push(event.data);
    recorder.onstop = () => {
      this.recorder = null;
      button.textContent = "Film";
      button.setAttribute("aria-pressed", "false");
      this.download("antnav.webm", new Blob(parts, { type: "video/webm" }));
    };
    this.recorder = recorder;
    button.textContent = "Stop film";
    button.setAttribute("aria-pressed", "true");
    recorder.start(250);
  }

  download(name, blob) {
    const url = URL.createObjectURL(blob);
    element("a", { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
  }

  // The address follows what is seen, so that a reload shows it again.
  share() {
    if (!this.transport.linkable) return;
    clearTimeout(this.sharing);
    this.sharing = setTimeout(() => this.say({ do: "save", what: "link", panel: 0 }), 600);
  }
}

export const mount = (root, transport) => {
  const view = new View(root, transport);
  root.antnavView = view;
  return view;
};

// The notebook widget: the same, over the widget's own channel.
export default {
  render({ model, el }) {
    const root = element("div");
    el.append(root);
    mount(root, {
      linkable: false,
      connect({ opened, heard }) {
        model.on("msg:custom", (message, buffers) => {
          if (message.packet) {
            const bytes = buffers[0];
            heard(bytes.buffer ? bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) : bytes);
          } else heard(JSON.stringify(message));
        });
        setTimeout(opened, 0);
        return {
          send: (data) => (typeof data === "string" ? model.send({ message: data }) : model.send({ bytes: true }, undefined, [data])),
        };
      },
    });
  },
};
