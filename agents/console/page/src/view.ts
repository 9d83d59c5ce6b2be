// The picture of the local perceptual space, robot-centered or global, on a canvas (manual 2.3.2).
import {compose, identity, inverse} from './geometry';
import {pursued} from './goals';
import type {Link} from './link';
import {facing, zoneOf, type Sketch} from './map_edit';
import {drawShape} from './shapes';
import type {Argument, Behaviors, Drawing, GridTile, MapArtifact, Perception, Pose, ProgramMind, Registration,
             RobotDescription, RobotState, SaphiraMap, Vision} from './types';

const wakeTime = 10_000;     // [ms] (manual 2.3.4.4)
const pointingCycles = 20;   // for which an arm counts after it was seen
const echoTime = 30_000;     // [ms]
const mostEchoes = 1500;
const ahead = 150;           // [ms] that the robot's way is drawn on without news
const top = 56;              // [pixels] of the picture, under its buttons
const bottom = 30;           // [pixels] under its scale
const small = 20;            // [pixels/m] from which on down the labels are smaller
const crossSize = 9;         // [pixels] of a goal
const apart = 4;             // [pixels] between two labels
const rankOf: {[type: string]: number} = {ARTIFACT_OFFICE: 0, ARTIFACT_CORRIDOR: 1, ARTIFACT_DOOR: 2};
const otherRank = 3;
export const zoneColor: {[rule: string]: string} = {ZONE_KEEP_OUT: '#d32f2f', ZONE_SLOW: '#e69f00', ZONE_ONE_WAY: '#1976d2', ZONE_PREFERRED: '#2e9d55'};
export const doubt = 0.5;    // of the confidence of a pose: a higher one is confirmed by what was heard
const guessed = 0.35;        // opacity of what was heard, where the place is a guess
const regionTypes = ['ARTIFACT_OFFICE', 'ARTIFACT_CORRIDOR', 'ARTIFACT_LANE', 'ARTIFACT_JUNCTION'];

export interface Layers { grid: boolean; sonar: boolean; map: boolean; route: boolean; drawings: boolean; percepts: boolean; areas: boolean; wake: boolean }
export interface Target {
  x: number; y: number; frame: 'map' | 'odom'; artifact?: MapArtifact;
  zones: MapArtifact[];      // around it
  routed: boolean;           // on a map with rooms or corridors, by which routes lead
}
interface Echo { x: number; y: number; at: number }
interface Colors { [name: string]: string }
interface Label { text: string; x: number; y: number; room: number; rank: number }   // room: [m] that it names
interface Placed { text: string; x: number; y: number; below: number }   // [pixels] below its place
interface MapLines {
  map: SaphiraMap; closed: string; scale: number;
  strokes: Map<string, {path: Path2D; color: string; width: number; dash: number[]}>;
  labels: Label[];           // the important ones first
  placed?: {turn: string; labels: Placed[]};
  view?: string; picture?: HTMLCanvasElement;
}

export class View {
  local = false;
  follow = true;
  scale = 45;                // [pixels/m]
  layers: Layers = {grid: true, sonar: true, map: true, route: true, drawings: true, percepts: true, areas: true, wake: true};
  target?: Target;           // that was clicked
  sketch?: Sketch;           // that is being drawn
  onSketch = () => {};
  whole = false;             // all of the map is in the picture, and is to stay so
  bottom = 0;                // [pixels] of the picture, from below, that something at its left lies over
  left = 0;                  // [pixels] the same, from the left
  dirty = true;

  private context: CanvasRenderingContext2D;
  private center = {x: 0, y: 0};       // of the global view, in the world
  private echoes: Echo[] = [];
  private wake: Echo[] = [];
  private cycle = -1;
  private undrawn?: number;            // [ms] when what is not drawn yet was true
  private odom = -1;
  private tiles = new Map<string, {data: GridTile; image: HTMLCanvasElement; dark: boolean}>();
  private colors: Colors = {};
  private crosses: Pose[] = [];   // of goals, in the picture
  private lines?: MapLines;
  private widths = new Map<string, number>();   // [pixels] of texts, at the size of 10
  private dark = false;
  private ratio = 1;

  constructor(private canvas: HTMLCanvasElement, private link: Link) {
    this.context = canvas.getContext('2d')!;
    this.readColors();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.readColors());
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  private readColors() {
    const style = getComputedStyle(document.documentElement);
    for (const name of ['ground', 'seen', 'wall', 'door', 'corridor', 'percept', 'echo', 'wake', 'robot', 'robot-edge',
                        'goal', 'text', 'muted', 'person', 'closed', 'uncertain'])
      this.colors[name] = style.getPropertyValue('--map-' + name).trim();
    this.dark = matchMedia('(prefers-color-scheme: dark)').matches;
    this.dirty = true;
  }

  private resize() {
    this.ratio = Math.min(devicePixelRatio || 1, 2);
    this.canvas.width = Math.max(1, Math.round(this.canvas.clientWidth * this.ratio));
    this.canvas.height = Math.max(1, Math.round(this.canvas.clientHeight * this.ratio));
    this.dirty = true;
    if (this.whole) this.fit();
  }

  // Where odom is in the world that is drawn: the map, where the robot is known to be on it.
  private odomInWorld(): Pose {
    return this.onMap() ? this.link.data<Registration>('registration')!.odom_in_map : identity;
  }
  onMap(): boolean {
    const registration = this.link.data<Registration>('registration');
    const map = this.link.data<SaphiraMap>('map');
    return !!registration && !!map && map.artifacts.length > 0 &&
        registration.state !== 'REGISTRATION_UNPLACED';
  }

  private lost(): boolean { return this.link.data<Registration>('registration')?.state === 'REGISTRATION_LOST'; }

  // The robot in the world, a little ahead of what was heard last, so that it moves evenly.
  robotInWorld(): Pose | undefined {
    const item = this.link.get<RobotState>('robot/state');
    if (!item) return undefined;
    const {pose_in_odom: p, velocity, rotation_velocity} = item.data;
    const t = Math.min(Math.max(performance.now() - item.at, 0), ahead) / 1000;
    return compose(this.odomInWorld(), compose(p, {x: velocity * t, y: 0, th: rotation_velocity * t}));
  }

  // Takes in the newest robot state: echoes and wake.
  news() {
    this.dirty = true;
    const item = this.link.get<RobotState>('robot/state');
    if (!item || item.data.stamp.cycle === this.cycle) return;
    const robot = item.data;
    if (robot.odom !== this.odom || robot.stamp.cycle < this.cycle) {
      this.echoes = [];
      this.wake = [];
      this.odom = robot.odom;
    }
    this.cycle = robot.stamp.cycle;
    this.undrawn = item.at;
    const now = performance.now();
    const last = this.wake[this.wake.length - 1];
    if (!last || Math.hypot(last.x - robot.pose_in_odom.x, last.y - robot.pose_in_odom.y) > 0.03)
      this.wake.push({x: robot.pose_in_odom.x, y: robot.pose_in_odom.y, at: now});
    const description = this.link.data<RobotDescription>('robot/description');
    for (const reading of robot.sonars) {
      const sonar = description?.sonars.find(s => s.sonar === reading.sonar);
      if (!sonar || !reading.echo) continue;
      const point = compose(robot.pose_in_odom, compose(sonar.pose_in_robot, {x: reading.range, y: 0, th: 0}));
      this.echoes.push({x: point.x, y: point.y, at: now});
    }
    if (this.echoes.length > mostEchoes) this.echoes.splice(0, this.echoes.length - mostEchoes);
  }

  clearEchoes() {
    this.echoes = [];
    this.dirty = true;
  }

  zoom(factor: number) {
    this.scale = Math.min(400, Math.max(4, this.scale * factor));
    this.whole = false;
    this.dirty = true;
  }
  // [pixels of the page]
  drag(dx: number, dy: number) {
    if (this.local) return;
    this.follow = this.whole = false;
    this.center.x -= dx / this.scale;
    this.center.y += dy / this.scale;
    this.dirty = true;
  }
  // Everything that there is on the map, in the picture.
  fit() {
    const artifacts = this.link.data<SaphiraMap>('map')?.artifacts ?? [];
    const robot = this.robotInWorld();
    const xs = robot ? [robot.x] : [], ys = robot ? [robot.y] : [];
    if (this.onMap())
      for (const {pose_in_map: p, length, width} of artifacts) {
        const [c, s] = [Math.abs(Math.cos(p.th)), Math.abs(Math.sin(p.th))];
        const [dx, dy] = [(length * c + width * s) / 2, (length * s + width * c) / 2];
        xs.push(p.x - dx, p.x + dx);
        ys.push(p.y - dy, p.y + dy);
      }
    if (xs.length === 0) return;
    const least = (values: number[]) => values.reduce((a, b) => Math.min(a, b)), most = (values: number[]) => values.reduce((a, b) => Math.max(a, b));
    const [x0, x1, y0, y1] = [least(xs), most(xs), least(ys), most(ys)];
    this.local = this.follow = false;
    // Above what lies over the picture, or beside it: where it is larger.
    const fitted = (left: number, below: number) => {
      const height = Math.max(100, this.canvas.clientHeight - top - below);
      const scale = Math.min(120, 0.94 * (this.canvas.clientWidth - left) / Math.max(1, x1 - x0), height / Math.max(1, y1 - y0));
      return {scale, center: {x: (x0 + x1) / 2 - left / 2 / scale, y: (y0 + y1) / 2 + (top - below) / 2 / scale}};
    };
    const above = fitted(0, Math.max(bottom, this.bottom)), next = fitted(this.left, bottom);
    Object.assign(this, next.scale > above.scale ? next : above);
    this.whole = this.dirty = true;
  }

  // The view's own frame: x to the right and y up of the screen's middle, in meters.
  private worldInView(): Pose {
    const robot = this.robotInWorld() ?? identity;
    if (this.local) return compose({x: 0, y: 0, th: Math.PI / 2}, inverse(robot));
    if (this.follow) this.center = {x: robot.x, y: robot.y};
    return {x: -this.center.x, y: -this.center.y, th: 0};
  }

  // The target at a point of the canvas [pixels of the page].
  at(px: number, py: number): Target {
    const in_view = {x: (px - this.canvas.clientWidth / 2) / this.scale,
                     y: -(py - this.canvas.clientHeight / 2) / this.scale, th: 0};
    const world = compose(inverse(this.worldInView()), in_view);
    const artifacts = this.onMap() ? this.link.data<SaphiraMap>('map')!.artifacts : [];
    const near = artifacts
        .filter(a => a.name && (a.type === 'ARTIFACT_DOOR' || a.type === 'ARTIFACT_OFFICE' || a.type === 'ARTIFACT_POSITION'))
        .map(a => ({a, d: Math.hypot(a.pose_in_map.x - world.x, a.pose_in_map.y - world.y)}))
        .sort((l, r) => l.d - r.d)[0];
    // A click anywhere in a room means the room.
    const around = artifacts.filter(a => {
      const at = compose(inverse(a.pose_in_map), {...world, th: 0});
      return Math.abs(at.x) < a.length / 2 && Math.abs(at.y) < a.width / 2;
    });
    const room = around.find(a => a.name && a.type === 'ARTIFACT_OFFICE');
    return {x: world.x, y: world.y, frame: this.onMap() ? 'map' : 'odom',
            zones: around.filter(a => a.type === 'ARTIFACT_ZONE'),
            routed: artifacts.some(a => regionTypes.includes(a.type)),
            artifact: near && near.d * this.scale < 22 ? near.a : room};
  }

  inWindow(): DOMRect { return this.canvas.getBoundingClientRect(); }
  // The place that was clicked, and that of what it means [pixels of the window].
  targetInWindow(): {x: number; y: number}[] {
    if (!this.target) return [];
    const {left, top, width, height} = this.inWindow(), world = this.worldInView();
    return [this.target, this.target.artifact?.pose_in_map ?? this.target].map(({x, y}) => {
      const at = compose(world, {x, y, th: 0});
      return {x: left + width / 2 + at.x * this.scale, y: top + height / 2 - at.y * this.scale};
    });
  }

  draw() {
    const {context: c, colors} = this;
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.fillStyle = colors.ground;
    c.fillRect(0, 0, this.canvas.width, this.canvas.height);
    // Meters, y up, the world's frame.
    const k = this.scale * this.ratio;
    c.setTransform(k, 0, 0, -k, this.canvas.width / 2, this.canvas.height / 2);
    const view = this.worldInView();
    c.translate(view.x, view.y);
    c.rotate(view.th);
    c.lineCap = 'round';
    const odom = this.odomInWorld();
    if (this.layers.grid) this.drawGrid(odom);
    if (this.layers.map && this.onMap()) this.drawMap();
    this.within(odom, () => {
      if (this.layers.wake) this.drawWake();
      if (this.layers.percepts) this.drawPercepts();
      if (this.layers.sonar) this.drawEchoes();
      this.drawPeople();
    });
    this.drawGoals(odom);
    this.drawDrawings(odom);
    const robot = this.robotInWorld();
    if (robot) {
      this.drawUncertainty();
      this.within(robot, () => {
        if (this.layers.areas) this.drawAreas();
        this.drawRobot(robot, odom);
      });
      this.drawCoveredLabels(robot);
      if (this.onMap() && this.lost()) this.label('lost', robot.x, robot.y - this.robotRadius() - this.px(10), colors.text, 13);
    }
    if (this.target) this.drawTarget(this.target);
    if (this.sketch) this.drawSketch(this.sketch);
    this.drawScale();
    this.dirty = false;
    if (this.undrawn !== undefined) this.link.drawn(performance.now() - this.undrawn);
    this.undrawn = undefined;
  }

  private within(frame: Pose, draw: () => void) {
    const c = this.context;
    c.save();
    c.translate(frame.x, frame.y);
    c.rotate(frame.th);
    draw();
    c.restore();
  }
  // So many pixels of the page, in meters.
  private px(pixels: number) { return pixels / this.scale; }
  private line(points: [number, number][], color: string, width: number, dash: number[] = []) {
    const c = this.context;
    c.strokeStyle = color;
    c.lineWidth = width;
    c.setLineDash(dash);
    c.beginPath();
    points.forEach(([x, y], i) => i ? c.lineTo(x, y) : c.moveTo(x, y));
    c.stroke();
    c.setLineDash([]);
  }
  private label(text: string, x: number, y: number, color: string, size = 11) {
    const c = this.context;
    const m = c.getTransform();
    const at = new DOMPoint(x, y).matrixTransform(m);
    c.save();
    c.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    c.font = `${size}px system-ui, sans-serif`;
    c.textAlign = 'center';
    c.textBaseline = 'middle';
    c.lineWidth = 3;
    c.strokeStyle = this.colors.ground;
    c.fillStyle = color;
    c.strokeText(text, at.x / this.ratio, at.y / this.ratio);
    c.fillText(text, at.x / this.ratio, at.y / this.ratio);
    c.restore();
  }

  private drawGrid(odom: Pose) {
    const seen = new Set<string>();
    this.context.imageSmoothingEnabled = false;
    this.context.globalAlpha = this.onMap() && this.lost() ? guessed : 1;
    for (const [key, {data}] of this.link.all<GridTile>('perception/grid')) {
      if (this.odom !== -1 && data.odom !== this.odom) continue;
      seen.add(key);
      let tile = this.tiles.get(key);
      if (!tile || tile.data !== data || tile.dark !== this.dark) {
        tile = {data, image: this.paint(data), dark: this.dark};
        this.tiles.set(key, tile);
      }
      const edge = data.side * data.resolution;
      this.within(odom, () => this.context.drawImage(tile!.image, data.column * edge, data.row * edge, edge, edge));
    }
    this.context.globalAlpha = 1;
    for (const key of this.tiles.keys())
      if (!seen.has(key)) this.tiles.delete(key);
  }
  // Free is lighter than the ground of what was never seen, occupied is darker; row 0 is the smallest y.
  private paint(tile: GridTile): HTMLCanvasElement {
    const image = document.createElement('canvas');
    image.width = image.height = tile.side;
    const c = image.getContext('2d')!;
    const pixels = c.createImageData(tile.side, tile.side);
    const [fr, fg, fb] = this.rgb(this.colors.seen), [or, og, ob] = this.rgb(this.colors.muted);
    tile.cells.forEach((cell, i) => {
      if (cell === 255) return;
      const p = cell / 200;
      const full = p > 0.5;
      pixels.data.set(full ? [or, og, ob, Math.min(255, (p - 0.5) * 340)] : [fr, fg, fb, Math.min(255, (0.5 - p) * 510)], 4 * i);
    });
    c.putImageData(pixels, 0, 0);
    return image;
  }
  private rgb(color: string): [number, number, number] {
    const n = parseInt(color.slice(1), 16);
    return [n >> 16, (n >> 8) & 255, n & 255];
  }

  // The lines of the map by their looks, so that a large one costs a few strokes a frame: made anew where
  // the map, its closed doors or the scale are others.
  private mapLines(map: SaphiraMap, shut: Set<number>): MapLines {
    const closed = [...shut].join();
    if (this.lines?.map === map && this.lines.closed === closed && this.lines.scale === this.scale) return this.lines;
    const made: MapLines = {map, closed, scale: this.scale, strokes: new Map(), labels: []};
    // The doors and openings of a room bear its name: once is enough.
    const isWay = (a: MapArtifact) => a.type === 'ARTIFACT_DOOR' || a.type === 'ARTIFACT_BREAK';
    const rooms = new Set(map.artifacts.filter(a => !isWay(a) && a.type !== 'ARTIFACT_ZONE').map(a => a.name));
    for (const a of map.artifacts) {
      const p = a.pose_in_map, [cos, sin] = [Math.cos(p.th), Math.sin(p.th)];
      // Points in the artifact's own frame; width and dashes in pixels.
      const stroke = (color: string, width: number, dash: string, ...points: [number, number][]) => {
        const key = [color, width, dash].join();
        const path = made.strokes.get(key)?.path ?? new Path2D();
        made.strokes.set(key, {path, color, width, dash: dash ? dash.split(' ').map(Number) : []});
        points.forEach(([x, y], i) => {
          const at: [number, number] = [p.x + cos * x - sin * y, p.y + sin * x + cos * y];
          if (i) path.lineTo(...at);
          else path.moveTo(...at);
        });
      };
      const l = a.length / 2, w = a.width / 2, s = this.px(3), learned = a.learned ? '4 4' : '';
      switch (a.type) {
        case 'ARTIFACT_WALL':
          stroke('wall', 2.5, learned, [-l, 0], [l, 0]);
          break;
        case 'ARTIFACT_CORRIDOR':
        case 'ARTIFACT_LANE':
          stroke('corridor', 1, '8 5', [-l, w], [l, w]);
          stroke('corridor', 1, '8 5', [-l, -w], [l, -w]);
          break;
        case 'ARTIFACT_DOOR':
        case 'ARTIFACT_BREAK':
          stroke(shut.has(a.id) ? 'closed' : 'door', 4, learned, [0, -w], [0, w]);
          break;
        case 'ARTIFACT_OFFICE':
          stroke('corridor', 1, learned, [-l, -w], [l, -w], [l, w], [-l, w], [-l, -w]);
          break;
        case 'ARTIFACT_ZONE':
          break;   // an area of its own
        default:
          stroke('corridor', 1.5, '', [-s, 0], [s, 0]);
          stroke('corridor', 1.5, '', [0, -s], [0, s]);
      }
      if (a.name && !(isWay(a) && rooms.has(a.name)))
        made.labels.push({text: a.name, x: p.x, y: p.y, room: Math.max(a.length, a.width), rank: rankOf[a.type] ?? otherRank});
    }
    made.labels.sort((l, r) => l.rank - r.rank || r.room - l.room);
    this.lines = made;
    return made;
  }
  private drawMap() {
    const c = this.context, m = c.getTransform();
    for (const zone of this.link.data<SaphiraMap>('map')!.artifacts.filter(a => a.type === 'ARTIFACT_ZONE'))
      this.within(zone.pose_in_map, () => this.drawZone(zone));
    const lines = this.mapLines(this.link.data<SaphiraMap>('map')!, new Set(this.link.data<Registration>('registration')?.closed_doors));
    // A view that rests has them as a picture.
    const view = [m.a, m.b, m.c, m.d, m.e, m.f, this.canvas.width, this.canvas.height, this.dark].join();
    if (lines.view !== view) {
      lines.view = view;
      lines.picture = undefined;
      this.strokeLines(lines, c);
      this.drawLabels(lines, c);
    } else {
      if (!lines.picture) {
        lines.picture = document.createElement('canvas');
        lines.picture.width = this.canvas.width;
        lines.picture.height = this.canvas.height;
        const still = lines.picture.getContext('2d')!;
        still.setTransform(m);
        this.strokeLines(lines, still);
        this.drawLabels(lines, still);
      }
      c.save();
      c.resetTransform();
      c.drawImage(lines.picture, 0, 0);
      c.restore();
    }
  }
  private drawZone(zone: MapArtifact) {
    const c = this.context, l = zone.length / 2, w = zone.width / 2, color = zoneColor[zone.rule] ?? zoneColor.ZONE_KEEP_OUT;
    c.globalAlpha = 0.2;
    c.fillStyle = color;
    c.fillRect(-l, -w, zone.length, zone.width);
    c.globalAlpha = 1;
    this.line([[-l, -w], [l, -w], [l, w], [-l, w], [-l, -w]], color, this.px(1.5), [this.px(6), this.px(4)]);
    if (zone.rule !== 'ZONE_ONE_WAY') return;
    const tip = Math.min(1, l), wing = tip / 3;
    this.line([[-tip, 0], [tip, 0]], color, this.px(3));
    this.line([[tip - wing, wing], [tip, 0], [tip - wing, -wing]], color, this.px(3));
  }
  private fontSize() { return this.scale < small ? 10 : 11; }
  private width(text: string): number {
    let width = this.widths.get(text);
    if (width === undefined) {
      this.context.font = '10px system-ui, sans-serif';
      this.widths.set(text, width = this.context.measureText(text).width);
    }
    return width * this.fontSize() / 10;
  }
  // The labels that do not lie over one that is more important. A map that only moves keeps them.
  private placeLabels(lines: MapLines, m: DOMMatrix): Placed[] {
    const turn = [m.a, m.b, m.c, m.d].join();
    if (lines.placed?.turn === turn) return lines.placed.labels;
    const turned = m.b !== 0, within = this.inPicture();
    const height = this.fontSize() + apart, rows = new Map<number, {left: number; right: number; y: number}[]>();
    const labels: Placed[] = [];
    for (const label of lines.labels) {
      if (turned && !within(label.x, label.y)) continue;
      const width = this.width(label.text);
      // From far away: the rooms that have place for their name.
      if (this.scale < small && (label.rank > 1 ? this.scale < small / 2 : width > label.room * this.scale + 2 * apart)) continue;
      const x = (m.a * label.x + m.c * label.y) / this.ratio, y = (m.b * label.x + m.d * label.y) / this.ratio;
      const left = x - width / 2 - apart, right = x + width / 2 + apart;
      // In its place, else below it, else above.
      for (const below of [0, height, -height]) {
        const row = Math.floor((y + below) / height);
        const free = [row - 1, row, row + 1].every(r => (rows.get(r) ?? []).every(o =>
          Math.abs(o.y - y - below) >= height || o.left >= right || o.right <= left));
        if (!free) continue;
        const others = rows.get(row);
        if (others) others.push({left, right, y: y + below});
        else rows.set(row, [{left, right, y: y + below}]);
        labels.push({text: label.text, x: label.x, y: label.y, below});
        break;
      }
    }
    if (!turned) lines.placed = {turn, labels};
    return labels;
  }
  // Robot and goals cover no name: those under it come once more, over it.
  private drawCoveredLabels(robot: Pose) {
    if (this.local || !this.layers.map || !this.onMap() || !this.lines) return;
    const over = [{...robot, size: this.robotRadius() * this.scale}, ...this.crosses.map(at => ({...at, size: crossSize}))];
    const {a, b, c, d} = this.context.getTransform();
    const covered = ({text, x, y, below}: Placed) => over.some(o =>
      Math.abs(a * (x - o.x) + c * (y - o.y)) / this.ratio < o.size + this.width(text) / 2 &&
      Math.abs((b * (x - o.x) + d * (y - o.y)) / this.ratio + below) < o.size + this.fontSize() / 2);
    this.drawLabels(this.lines, this.context, covered);
  }
  private drawLabels(lines: MapLines, c: CanvasRenderingContext2D, wanted: (label: Placed) => boolean = () => true) {
    const m = c.getTransform(), labels = this.placeLabels(lines, m), within = this.inPicture();
    c.save();
    c.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    c.font = `${this.fontSize()}px system-ui, sans-serif`;
    c.textAlign = 'center';
    c.textBaseline = 'middle';
    c.lineWidth = 3;
    c.strokeStyle = this.colors.ground;
    c.fillStyle = this.colors.text;
    for (const {text, x, y, below} of labels.filter(wanted)) {
      if (!within(x, y)) continue;
      const [px, py] = [(m.a * x + m.c * y + m.e) / this.ratio, (m.b * x + m.d * y + m.f) / this.ratio + below];
      c.strokeText(text, px, py);
      c.fillText(text, px, py);
    }
    c.restore();
  }
  private strokeLines({strokes}: MapLines, c: CanvasRenderingContext2D) {
    c.lineCap = 'butt';  // round ones of thousands of lines take most of the time
    for (const {path, color, width, dash} of strokes.values()) {
      c.strokeStyle = this.colors[color];
      c.lineWidth = this.px(width);
      c.setLineDash(dash.map(pixels => this.px(pixels)));
      c.stroke(path);
    }
    c.setLineDash([]);
    c.lineCap = 'round';
  }
  // A test that is true for a point of the world in the picture or just outside.
  private inPicture(): (x: number, y: number) => boolean {
    const m = this.context.getTransform(), [w, h] = [this.canvas.width, this.canvas.height];
    return (x, y) => {
      const at = [m.a * x + m.c * y + m.e, m.b * x + m.d * y + m.f] as const;
      return at[0] > -100 && at[0] < w + 100 && at[1] > -30 && at[1] < h + 30;
    };
  }

  private drawWake() {
    const now = performance.now();
    this.wake = this.wake.filter(w => now - w.at < wakeTime);
    this.context.fillStyle = this.colors.wake;
    for (const w of this.wake) {
      this.context.globalAlpha = 0.2 + 0.6 * (1 - (now - w.at) / wakeTime);
      this.context.beginPath();
      this.context.arc(w.x, w.y, this.px(2), 0, 7);
      this.context.fill();
    }
    this.context.globalAlpha = 1;
  }

  private drawEchoes() {
    const c = this.context, now = performance.now();
    // By age, in steps, since each stroke costs: the newest round is larger (manual 2.3.2.2).
    const steps = 12, paths = Array.from({length: steps + 1}, () => new Path2D());
    for (const e of this.echoes) {
      const age = now - e.at;
      if (age > echoTime) continue;
      const fresh = age < 600, size = this.px(fresh ? 6 : 3);
      paths[fresh ? 0 : 1 + Math.min(steps - 1, Math.floor(steps * age / echoTime))].rect(e.x - size / 2, e.y - size / 2, size, size);
    }
    c.strokeStyle = this.colors.echo;
    c.lineWidth = this.px(1.2);
    paths.forEach((path, i) => {
      c.globalAlpha = i ? 0.7 * (1 - (i - 0.5) / steps) : 1;
      c.stroke(path);
    });
    c.globalAlpha = 1;
  }

  private drawPercepts() {
    const perception = this.link.data<Perception>('perception');
    if (!perception || perception.odom !== this.odom) return;
    const c = this.context, color = this.colors.percept;
    for (const p of perception.percepts) {
      c.globalAlpha = 0.25 + 0.75 * Math.min(1, Math.max(0, p.confidence));
      this.within(p.pose_in_odom, () => {
        const l = p.length / 2, w = p.width / 2;
        if (p.type === 'ARTIFACT_WALL') this.line([[-l, 0], [l, 0]], color, this.px(4));
        else if (p.type === 'ARTIFACT_CORRIDOR') {
          this.line([[-l, w], [l, w]], color, this.px(1.5), [this.px(3), this.px(4)]);
          this.line([[-l, -w], [l, -w]], color, this.px(1.5), [this.px(3), this.px(4)]);
        } else if (p.type === 'ARTIFACT_DOOR' || p.type === 'ARTIFACT_JUNCTION') {
          const half = Math.max(w, 0.3);
          c.strokeStyle = color;
          c.lineWidth = this.px(2);
          c.strokeRect(-0.12, -half, 0.24, 2 * half);
        }
      });
    }
    c.globalAlpha = 1;
  }

  private drawPeople() {
    const vision = this.link.data<Vision>('vision');
    if (!vision || vision.odom !== this.odom) return;
    for (const t of vision.things) {
      if (!t.range_known) continue;
      const c = this.context;
      c.globalAlpha = 0.3 + 0.7 * t.confidence;
      c.fillStyle = this.colors.person;
      c.beginPath();
      c.arc(t.pose_in_odom.x, t.pose_in_odom.y, 0.22, 0, 7);
      c.fill();
      if (t.pointed && vision.stamp.cycle - t.pointed < pointingCycles) {
        const {x, y} = t.pose_in_odom;
        this.line([[x, y], [x + 0.8 * Math.cos(t.points), y + 0.8 * Math.sin(t.points)]], this.colors.person, this.px(4));
      }
      c.globalAlpha = 1;
    }
  }

  private frameIn(name: string, odom: Pose): Pose | undefined {
    if (name === 'FRAME_ODOM') return odom;
    if (name === 'FRAME_ROBOT') return this.robotInWorld();
    return this.onMap() ? identity : undefined;
  }

  private drawGoals(odom: Pose) {
    const {open} = pursued(this.link);
    this.crosses = [];
    for (const {goal, place} of open) {
      for (const argument of goal?.arguments ?? []) {
        const at = this.placeOf(argument, odom);
        if (!at) continue;
        this.cross(at, this.colors.goal, crossSize);
        this.crosses.push(at);
        if (open.length > 1 && place > 0) this.label(String(place), at.x + this.px(17), at.y + this.px(11), this.colors.goal, 13);
      }
    }
  }
  private placeOf({name, kind, text, point, frame: frameName}: Argument, odom: Pose): Pose | undefined {
    if (kind === 'ARGUMENT_TEXT' && name === 'place' && this.onMap())
      return this.link.data<SaphiraMap>('map')!.artifacts.find(a => a.name === text)?.pose_in_map;
    // A point relative to the robot is meant from where the robot was.
    if (kind !== 'ARGUMENT_POINT' || frameName === 'FRAME_ROBOT') return undefined;
    const frame = this.frameIn(frameName, odom);
    return frame && compose(frame, point);
  }
  private cross({x, y}: {x: number; y: number}, color: string, size: number) {
    const s = this.px(size), c = this.context;
    c.strokeStyle = color;
    c.lineWidth = this.px(2);
    c.beginPath();
    c.arc(x, y, s, 0, 7);
    c.stroke();
    this.line([[x - 1.5 * s, y], [x - 0.4 * s, y]], color, this.px(2));
    this.line([[x + 0.4 * s, y], [x + 1.5 * s, y]], color, this.px(2));
    this.line([[x, y - 1.5 * s], [x, y - 0.4 * s]], color, this.px(2));
    this.line([[x, y + 0.4 * s], [x, y + 1.5 * s]], color, this.px(2));
  }
  private drawTarget(target: Target) {
    this.cross(target, this.colors.text, target.artifact ? 4 : 7);
    if (target.artifact) this.cross(target.artifact.pose_in_map, this.colors.text, 7);
  }

  drawOn(sketch: Sketch) {
    this.sketch = sketch;
    this.dirty = true;
    this.onSketch();
  }
  private drawSketch(sketch: Sketch) {
    if (sketch.kind === 'zone') {
      const zone = zoneOf(sketch);
      return this.within(zone.pose_in_map, () => this.drawZone(zone));
    }
    const length = this.px(45), wing = this.px(9);
    this.within({...sketch.from, th: facing(sketch)}, () => {
      this.line([[0, 0], [length, 0]], this.colors.text, this.px(3));
      this.line([[length - wing, wing], [length, 0], [length - wing, -wing]], this.colors.text, this.px(3));
    });
  }

  private drawDrawings(odom: Pose) {
    const now = performance.now();
    for (const [, {data: d, at}] of this.link.all<Drawing>('drawings')) {
      if (!(d.source === 'intentions' ? this.layers.route : this.layers.drawings)) continue;
      const frame = this.frameIn(d.frame, odom);
      if (!frame || (d.lifetime > 0 && now - at > 1000 * d.lifetime)) continue;
      if (d.frame === 'FRAME_ODOM' && d.odom !== 0 && d.odom !== this.odom) continue;
      const color = `rgb(${d.red},${d.green},${d.blue})`;
      const width = d.width > 0 ? d.width : this.px(2);
      this.within(frame, () => drawShape(d, {
        line: points => this.line(points, color, d.shape === 'DRAWING_POINTS' ? Math.max(width, this.px(4)) : width),
        label: (text, x, y) => this.label(text, x, y, color, 12),
        head: this.px(9),
      }));
    }
  }
  // Two sigma of where the robot may be on the map.
  private drawUncertainty() {
    const registration = this.link.data<Registration>('registration');
    if (!registration || !this.onMap()) return;
    const {xx, xy, yy} = registration.covariance;
    const mean = (xx + yy) / 2, d = Math.hypot((xx - yy) / 2, xy);
    const c = this.context, p = this.robotInWorld()!;
    if (!(mean > 0)) return;
    c.save();
    c.translate(p.x, p.y);
    c.rotate(0.5 * Math.atan2(2 * xy, xx - yy));
    c.beginPath();
    c.ellipse(0, 0, 2 * Math.sqrt(Math.max(0, mean + d)), 2 * Math.sqrt(Math.max(0, mean - d)), 0, 0, 7);
    const lost = this.lost(), guess = lost || registration.confidence <= doubt;
    c.fillStyle = c.strokeStyle = lost ? this.colors.muted : this.colors.uncertain;
    c.lineWidth = this.px(guess ? 1.5 : 1);
    c.globalAlpha = 0.18;
    if (!guess) c.fill();
    c.globalAlpha = 0.7;
    if (guess) c.setLineDash([this.px(4), this.px(4)]);
    c.stroke();
    c.restore();
  }

  // Where behaviors with a say have found something (manual 2.3.2.5).
  private drawAreas() {
    const c = this.context;
    const sets = [this.link.data<Behaviors>('behaviors/state'), ...this.link.all<ProgramMind>('programs/mind').map(([, item]) => item.data.behaviors)];
    c.strokeStyle = this.colors.percept;
    c.lineWidth = this.px(1);
    for (const set of sets)
      for (const b of set?.behaviors ?? [])
        if (b.running && Math.max(b.turn_activity, b.speed_activity) > 0.05)
          for (const a of b.areas) c.strokeRect(a.x_from, a.y_from, a.x_to - a.x_from, a.y_to - a.y_from);
  }

  private robotRadius() { return Math.max(this.link.data<RobotDescription>('robot/description')?.radius ?? 0.22, this.px(9)); }
  private drawRobot(robot: Pose, odom: Pose) {
    const c = this.context, {colors} = this;
    const state = this.link.data<RobotState>('robot/state')!;
    const description = this.link.data<RobotDescription>('robot/description');
    const radius = this.robotRadius(), nose = 0.9;   // [rad] where the nose leaves the circle
    c.beginPath();
    c.arc(0, 0, radius, nose, -nose);
    c.lineTo(radius / Math.cos(nose), 0);
    c.closePath();
    const lost = this.onMap() && this.lost();
    c.fillStyle = colors.robot;
    if (!lost) c.fill();
    c.strokeStyle = lost ? colors.muted : colors['robot-edge'];
    c.lineWidth = this.px(1.5);
    if (lost) c.setLineDash([this.px(4), this.px(3)]);
    c.stroke();
    c.setLineDash([]);
    c.beginPath();
    c.moveTo(radius * 1.2, 0);
    c.lineTo(-radius * 0.65, radius * 0.42);
    c.lineTo(-radius * 0.35, 0);
    c.lineTo(-radius * 0.65, -radius * 0.42);
    c.closePath();
    c.fillStyle = lost ? colors.muted : colors['robot-edge'];
    c.fill();
    // The direction of cameras that turn.
    if (description && description.head_reach > 0)
      this.line([[0, 0], [(radius + 0.6) * Math.cos(state.head), (radius + 0.6) * Math.sin(state.head)]], colors.person, this.px(1.5), [this.px(5), this.px(4)]);
    // Velocity vectors (manual 2.3.2.4): forward, and to the side that it turns to.
    if (Math.abs(state.velocity) > 0.005)
      this.line([[0, 0], [Math.sign(state.velocity) * radius + 2 * state.velocity, 0]], colors.goal, this.px(2.5));
    if (Math.abs(state.rotation_velocity) > 0.01)
      this.line([[0, 0], [0, Math.sign(state.rotation_velocity) * radius + state.rotation_velocity]], colors.goal, this.px(2.5));
    // The control point (manual 2.3.2.3): where the server turns to.
    c.save();
    c.rotate(state.target_heading_in_odom + odom.th - robot.th);
    c.strokeStyle = colors.goal;
    c.lineWidth = this.px(1.5);
    c.strokeRect(radius + this.px(8), -this.px(3), this.px(12), this.px(6));
    c.restore();
  }

  private drawScale() {
    const c = this.context, {colors} = this;
    let meters = 1;
    for (const m of [0.2, 0.5, 1, 2, 5, 10])
      if (m * this.scale <= 110) meters = m;
    c.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    const x = 14, y = this.canvas.clientHeight - 16;
    this.line([[x, y - 4], [x, y], [x + meters * this.scale, y], [x + meters * this.scale, y - 4]], colors.text, 1.2);
    c.font = '11px system-ui, sans-serif';
    c.textAlign = 'left';
    c.textBaseline = 'bottom';
    c.fillStyle = colors.text;
    c.fillText(`${meters} m`, x + 5, y - 3);
  }
}
