const film = JSON.parse(document.getElementById("film").textContent);
const { rows, cols, block } = film;
const ticks = film.ticks;

// Streams of whole numbers: seven bits a byte, the eighth says that more follow; signed ones are zigzag.
const reader = (text) => {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  let at = 0;
  const next = () => {
    let value = 0;
    for (let scale = 1; ; scale *= 128) {
      const byte = bytes[at++];
      value += (byte & 127) * scale;
      if (byte < 128) return value;
    }
  };
  const signed = () => {
    const value = next();
    return value % 2 ? -(value + 1) / 2 : value / 2;
  };
  return { next, signed, more: () => at < bytes.length };
};

const readMap = (text) => {
  const shades = new Uint8Array(rows * cols);
  const { next, more } = reader(text);
  for (let at = 0; more(); ) {
    const value = next();
    const shade = value % 8, count = (value - shade) / 8;
    shades.fill(shade, at, (at += count));
  }
  return shades;
};

// Of each tick: starts, lengths and shades of runs of pixels.
const readChanges = (text) => {
  const { next } = reader(text);
  return Array.from({ length: ticks }, () => {
    const runs = [];
    let at = 0;
    for (let left = next(); left > 0; left--) {
      at += next();
      const value = next(), shade = value % 8, count = (value - shade) / 8;
      runs.push([at, count, shade]);
      at += count;
    }
    return runs;
  });
};

const readCells = (text) => {
  const { signed, more } = reader(text);
  const cells = [];
  let row = 0, col = 0;
  while (more()) {
    row += signed();
    col += signed();
    cells.push([row, col]);
  }
  return cells;
};

// What is left of a way, given by the cells where it turns, after so many moves.
const rest = (cells, moves) => {
  for (let i = 0; i + 1 < cells.length; i++) {
    const [row, col] = cells[i], down = cells[i + 1][0] - row, aside = cells[i + 1][1] - col;
    const count = Math.max(Math.abs(down), Math.abs(aside));
    if (moves < count) {
      const share = moves / count;
      return [[row + down * share, col + aside * share], ...cells.slice(i + 1)];
    }
    moves -= count;
  }
  return cells.slice(-1);
};

const map = readMap(film.map);
const changes = readChanges(film.changes);
const drives = film.drives.map((drive) => {
  let passed = 0;
  return {
    ...drive,
    way: readCells(drive.way),
    passed: drive.moves.map((moves) => (passed += moves) - moves),
    plans: drive.plans.map(([tick, text]) => ({ tick, cells: readCells(text) })),
    count: drive.moves.length,
  };
});

const styles = getComputedStyle(document.documentElement);
const colour = (name) => styles.getPropertyValue(`--${name}`).trim();
const NAMES = ["free", "priced", "unknown", "inflated", "occupied", "blocked"];
const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16));
const packed = ([r, g, b]) => new Uint32Array(new Uint8Array([r, g, b, 255]).buffer)[0];
let palette, veiled;
const readPalette = () => {
  const parts = NAMES.map((name) => rgb(colour(name)));
  const veil = parts[2];
  palette = Uint32Array.from(parts, packed);
  veiled = Uint32Array.from(parts, (part) => packed(part.map((value, i) => value * 0.35 + veil[i] * 0.65)));
};

class Panel {
  constructor(drive) {
    this.drive = drive;
    const node = document.getElementById("panel").content.cloneNode(true);
    this.root = node.querySelector("section");
    this.root.querySelector("h2").textContent = drive.name;
    [this.canvas, this.chart] = this.root.querySelectorAll("canvas");
    this.text = this.root.querySelector(".now");
    this.canvas.setAttribute("aria-label", `Map with the way and the plan of ${drive.name}`);
    this.chart.setAttribute("aria-label", `Time of each replan of ${drive.name} in milliseconds, logarithmic`);
    document.getElementById("panels").append(node);
    this.small = new OffscreenCanvas(cols, rows);
    this.image = new ImageData(cols, rows);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.chart.addEventListener("click", (event) => {
      const { left, width } = this.chart.getBoundingClientRect();
      go(Math.floor(((event.clientX - left) / width) * ticks));
    });
    this.restart();
  }

  restart() {
    this.tick = -1;
    this.shades = map.slice();
    this.seen = new Uint8Array(rows * cols).fill(film.sensor === null ? 1 : 0);
    for (let at = 0; at < this.pixels.length; at++) this.paint(at);
  }

  paint(at) {
    this.pixels[at] = (this.seen[at] ? palette : veiled)[this.shades[at]];
  }

  robot(tick) {
    const { way, passed, count } = this.drive;
    return way[passed[Math.min(tick, count - 1)]];
  }

  look([row, col]) {
    const radius = film.sensor, middle = (block - 1) / 2, most = radius * (radius + 1);
    for (let r = Math.max(0, Math.floor((row - radius) / block)); r <= Math.min(rows - 1, (row + radius) / block); r++)
      for (let c = Math.max(0, Math.floor((col - radius) / block)); c <= Math.min(cols - 1, (col + radius) / block); c++) {
        const at = r * cols + c;
        if (this.seen[at] || (r * block + middle - row) ** 2 + (c * block + middle - col) ** 2 > most) continue;
        this.seen[at] = 1;
        this.paint(at);
      }
  }

  go(tick) {
    if (tick < this.tick) this.restart();
    while (this.tick < tick) {
      for (const [start, count, shade] of changes[++this.tick])
        for (let at = start; at < start + count; at++) {
          this.shades[at] = shade;
          this.paint(at);
        }
      if (film.sensor !== null && this.tick < this.drive.count) this.look(this.robot(this.tick));
    }
    this.draw();
  }

  draw() {
    const ratio = window.devicePixelRatio || 1;
    const width = this.canvas.clientWidth, scale = (width * ratio) / cols;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(scale * rows);
    const pen = this.canvas.getContext("2d");
    pen.imageSmoothingEnabled = scale < 1;
    this.small.getContext("2d").putImageData(this.image, 0, 0);
    pen.drawImage(this.small, 0, 0, this.canvas.width, this.canvas.height);
    const cell = scale / block, { drive, tick } = this, now = Math.min(tick, drive.count - 1);
    const line = (cells, name, thick) => {
      pen.beginPath();
      for (const [row, col] of cells) pen.lineTo((col + 0.5) * cell, (row + 0.5) * cell);
      pen.strokeStyle = colour(name);
      pen.lineWidth = thick * ratio;
      pen.lineJoin = pen.lineCap = "round";
      pen.stroke();
    };
    const mark = ([row, col], name, size, square) => {
      const x = (col + 0.5) * cell, y = (row + 0.5) * cell;
      pen.beginPath();
      square ? pen.rect(x - size, y - size, 2 * size, 2 * size) : pen.arc(x, y, size, 0, 7);
      pen.fillStyle = colour(name);
      pen.fill();
      pen.strokeStyle = colour("ink");
      pen.lineWidth = ratio;
      pen.stroke();
    };
    const thick = Math.min(Math.max((0.2 * cell) / ratio, 2), 4), size = Math.max(5 * ratio, 0.4 * cell);
    const plan = drive.plans.findLast((each) => each.tick <= now);
    line(rest(plan.cells, drive.passed[now] - drive.passed[plan.tick]), "plan", thick);
    line(drive.way.slice(0, drive.passed[now] + 1), "trail", thick);
    mark(film.goal, "goal", size, true);
    mark(this.robot(now), "trail", Math.max(size, film.radius * cell), false);
    this.bars(ratio);
    this.tell(now);
  }

  // Of a long replay, a bar is the longest time of the ticks that share its pixels.
  bars(ratio) {
    const { chart, drive, tick } = this;
    const width = (chart.width = Math.round(chart.clientWidth * ratio));
    const height = (chart.height = Math.round(chart.clientHeight * ratio));
    const pen = chart.getContext("2d");
    const most = Math.max(2.6, Math.log10(film.slowest / 1000) + 0.4);
    const y = (ms) => height * (1 - (Math.max(Math.log10(ms), -2) + 2.15) / (most + 2.15));
    pen.font = `${11 * ratio}px system-ui, sans-serif`;
    const step = Math.max(width / ticks, 2 * ratio), tops = new Map();
    drive.times.forEach((time, at) => {
      const bin = Math.floor((at * width) / ticks / step);
      if (time >= 0) tops.set(bin, Math.max(tops.get(bin) ?? 0, time));
    });
    pen.fillStyle = colour("bar");
    for (const [bin, time] of tops) {
      const top = y(Math.max(time, 1) / 1000);
      pen.fillRect(bin * step, top, Math.max(step - ratio, ratio), height - top);
    }
    for (const ms of [1, 10, 100]) {
      pen.strokeStyle = colour("line");
      pen.lineWidth = ratio;
      pen.beginPath();
      pen.moveTo(0, y(ms));
      pen.lineTo(width, y(ms));
      pen.stroke();
      pen.strokeStyle = colour("paper");
      pen.lineWidth = 3 * ratio;
      pen.strokeText(`${ms} ms`, 3 * ratio, y(ms) - 3 * ratio);
      pen.fillStyle = colour("faint");
      pen.fillText(`${ms} ms`, 3 * ratio, y(ms) - 3 * ratio);
    }
    pen.fillStyle = colour("ink");
    pen.fillRect(((tick + 0.5) * width) / ticks - ratio / 2, 0, ratio, height);
  }

  tell(now) {
    const { drive, tick } = this, time = drive.times[now];
    const there = drive.arrived && now === drive.count - 1;
    const parts = [film.words[drive.status[now]]];
    if (there) parts[0] += ` at tick ${now}`;
    else if (tick >= drive.count) parts[0] = "the replay has ended";
    parts.push(`${drive.driven[now].toFixed(1)} cells driven`);
    if (drive.cost[now] !== null && !there) parts.push(`${drive.cost[now].toFixed(1)} to go`);
    if (time >= 0 && now === tick) parts.push(`replanned in ${(time / 1000).toPrecision(2)} ms`);
    this.text.textContent = parts.join(" · ");
  }
}

readPalette();
const panels = drives.map((drive) => new Panel(drive));
const slider = document.getElementById("tick"), count = document.getElementById("count");
const button = document.getElementById("play"), speed = document.getElementById("speed");
slider.max = ticks - 1;
let current = 0, playing = false, before = 0, due = 0;

function go(tick) {
  current = Math.min(Math.max(tick, 0), ticks - 1);
  slider.value = current;
  count.textContent = `tick ${current} of ${ticks - 1}, ${(current * film.seconds).toFixed(1)} s`;
  for (const panel of panels) panel.go(current);
}

function play(on) {
  if (on && current === ticks - 1) go(0);
  playing = on;
  button.textContent = on ? "Pause" : "Play";
  before = performance.now();
  due = 0;
  if (on) requestAnimationFrame(advance);
}

function advance(time) {
  if (!playing) return;
  due += ((time - before) / 1000) * Number(speed.value);
  before = time;
  if (due >= 1) {
    go(current + Math.floor(due));
    due %= 1;
  }
  if (current === ticks - 1) play(false);
  else requestAnimationFrame(advance);
}

button.addEventListener("click", () => play(!playing));
slider.addEventListener("input", () => { play(false); go(Number(slider.value)); });
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("select")) return;
  const far = event.shiftKey ? 10 : 1;
  const moves = { ArrowLeft: current - far, ArrowRight: current + far, Home: 0, End: ticks - 1 };
  if (event.key === " ") {
    if (event.target === button) return; // a button's own key
    play(!playing);
  } else if (event.key in moves) {
    play(false);
    go(moves[event.key]);
  } else return;
  event.preventDefault();
});
new ResizeObserver(() => go(current)).observe(document.getElementById("panels"));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  readPalette();
  for (const panel of panels) panel.restart();
  go(current);
});
go(0);
