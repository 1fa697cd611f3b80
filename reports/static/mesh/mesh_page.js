// The page of one mesh: what is drawn, which triangle is chosen, and the start.

const NOTICED = 90; // pixels: what is smaller would be overlooked

class MeshPage {
  /**
   * @param {HTMLElement} host
   * @param {MeshData} mesh
   * @param {string} name of the files that a reader saves
   */
  constructor(host, mesh, name) {
    this.mesh = mesh;
    this.name = name;
    this.stage = /** @type {HTMLElement} */ (host.querySelector(".stage"));
    this.sentence = /** @type {HTMLElement} */ (host.querySelector(".sentence"));
    this.link = /** @type {HTMLAnchorElement} */ (host.querySelector("a.link"));
    this.input = /** @type {HTMLInputElement} */ (host.querySelector("input"));
    this.projection = new Projection(mesh);
    this.painter = new Painter(this.stage, this.projection);
    this.chosen = mesh.worst;
    this.frame = 0; // the request for the next one, if there is one
    this.turning = false;
    this.open();
    new ResizeObserver(() => {
      this.painter.resize();
      this.draw();
    }).observe(this.stage);
    this.choose(mesh.worst);
    this.listSizes(/** @type {HTMLElement} */ (host.querySelector(".size-key ul")));
  }

  /**
   * Show the whole; or, where the longest path would be too small there to be seen, that. Longest
   * edges grow along a path, often by far: its first half is what must be large enough.
   */
  open() {
    const { projection, mesh } = this;
    const { path } = mesh.path(mesh.worst);
    const first = path.slice(0, Math.ceil(path.length / 2));
    if (mesh.space) projection.face(path);
    this.painter.resize();
    if (projection.extent(first) < NOTICED) projection.zoomTo(first, 0.4);
    this.draw();
  }

  draw() {
    this.frame ||= requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    this.frame = 0;
    this.painter.paintMesh(this.turning);
    this.painter.paintPath(this.chosen);
    this.stage.dataset.drawn = String(this.mesh.m);
  }

  /** @param {number} t */
  choose(t) {
    this.chosen = t;
    const number = String(this.mesh.numbers[t]);
    this.sentence.textContent = pathSentence(this.mesh, t);
    this.stage.dataset.chosen = number;
    this.link.href = `#triangle=${number}`;
    this.link.textContent = `Link to triangle ${grouped(this.mesh.numbers[t])}`;
    if (document.activeElement !== this.input) this.input.value = number;
    if (!this.frame) this.painter.paintPath(t);
  }

  /**
   * Choose the triangle at a point of the stage, if there is one.
   * @param {number} x
   * @param {number} y
   */
  pick(x, y) {
    const t = this.projection.hit(x, y);
    if (t >= 0 && t !== this.chosen) this.choose(t);
  }

  /**
   * Choose a triangle, if there is one, and keep it in view.
   * @param {number | undefined} t
   */
  step(t) {
    if (t === undefined) return;
    this.choose(t);
    if (this.projection.reveal([t])) this.draw();
  }

  /**
   * Choose a triangle by the number that it has in the whole mesh.
   * @param {string} number
   */
  chooseNumber(number) {
    const place = number.trim() ? this.mesh.placeOf(Number(number)) : -1;
    if (place < 0) {
      this.sentence.textContent = absentSentence(this.mesh, number);
      return;
    }
    this.choose(place);
    this.projection.zoomTo(this.mesh.path(place).path);
    this.draw();
  }

  /** Choose the triangle that the page's address names, if it names one, and bring it into view. */
  followAddress() {
    const named = /^#triangle=(.*)$/.exec(location.hash);
    if (!named) return;
    this.chooseNumber(named[1]);
    this.stage.scrollIntoView({ block: "center" });
  }

  /** Save the drawing as it is in view. */
  savePicture() {
    this.painter.picture(this.chosen).toBlob((picture) => {
      if (picture) saveFile(`${this.name}-lepp.png`, picture);
    });
  }

  /** @param {string | undefined} what a button does */
  act(what) {
    const { projection, mesh } = this;
    if (what === "csv") saveCsv(`${this.name}-triangles.csv`, trianglesCsv(mesh));
    else if (what === "png") this.savePicture();
    else if (what === "whole") projection.fit();
    else if (what === "worst") {
      const { path } = mesh.path(mesh.worst);
      this.choose(mesh.worst);
      if (mesh.space) projection.face(path);
      projection.zoomTo(path, 0.8);
    } else {
      projection.zoom(what === "in" ? 1.5 : 1 / 1.5, projection.width / 2, projection.height / 2);
    }
    this.draw();
  }

  /**
   * Scale about a point of the stage, which goes to another.
   * @param {number} factor
   * @param {number} x
   * @param {number} y
   * @param {number} [toX]
   * @param {number} [toY]
   */
  zoom(factor, x, y, toX, toY) {
    this.projection.zoom(factor, x, y, toX, toY);
    this.draw();
  }

  /**
   * @param {number} aside
   * @param {number} down
   * @param {boolean} [held] whether more is to come before `rest`
   */
  turn(aside, down, held = false) {
    this.turning = held;
    this.projection.turn(aside, down);
    this.draw();
  }

  /** The reader lets go: what was left out while turning is drawn. */
  rest() {
    if (!this.turning) return;
    this.turning = false;
    this.draw();
  }

  /** @param {HTMLElement} list takes the shades of the LEPP sizes */
  listSizes(list) {
    list.replaceChildren(...this.mesh.classes.map(([low, high], k) => {
      const item = document.createElement("li");
      const box = document.createElement("i");
      box.style.background = `var(--scale-${this.mesh.shadeOf(k)})`;
      item.append(box, low === high ? String(low) : `${low}–${high}`);
      return item;
    }));
  }
}

/** @param {MeshAbout} about */
function wireHistograms({ name, histograms }) {
  for (const button of document.querySelectorAll("button[data-histogram]")) {
    const which = /** @type {HTMLElement} */ (button).dataset.histogram ?? "";
    const { header, counts } = histograms[which];
    button.addEventListener("click",
      () => saveCsv(`${name}-${which}.csv`, countsCsv(header, counts)));
  }
}

async function start() {
  const host = /** @type {HTMLElement} */ (document.querySelector(".mesh"));
  const about = JSON.parse(document.getElementById("mesh-drawing")?.textContent ?? "");
  const mesh = new MeshData(about, await inflate("mesh-data").arrayBuffer());
  const page = new MeshPage(host, mesh, about.name);
  new Controls(host, page);
  wireHistograms(about);
  page.followAddress();
  addEventListener("hashchange", () => page.followAddress());
  wireTheme(() => page.draw());
  printInLight(() => page.drawNow(), () => page.draw());
  document.documentElement.dataset.ready = "mesh";
}

start();
