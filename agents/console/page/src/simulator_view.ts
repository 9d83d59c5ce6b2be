// The simulated world as it is, on a canvas, and things that are dragged in it.
export interface Robot { x: number; y: number; th: number; name: string; radius: number; velocity: number; rotation: number;
  contacts: number; connected: boolean; sonars: number[][]; inputs: Inputs; outputs: number; head?: number }
// Of the user's devices: a bit for each pin, [5 V / 255] for each port, [ms].
export interface Inputs { digital: number; analog: number[]; timer: number }
export interface Person { name: string; x: number; y: number; th: number; radius: number; arm?: number[] }
export interface Door { name: string; leaf: number[]; open: boolean }
export interface Box { name: string; x: number; y: number; th: number; corners: number[][] }
export interface Post { name: string; x: number; y: number; radius: number; color: string }
export interface World { world: string; width: number; height: number; walls: number[][]; posts: Post[]; worlds: string[]; robots: string[] }
export interface Scene { time: number; paused: boolean; rate: number; robots: Robot[]; people: Person[]; doors: Door[]; boxes: Box[] }
// The things that can be chosen, such as "robot 0" and "person ann".
export type Kind = 'robot' | 'person' | 'box' | 'door';
export interface Thing { kind: Kind; name: string; x: number; y: number; th: number; reach: number }

const longestWake = 5000;
const nearEdge = 0.25;        // of the picture's side
const near = 0.35;            // [m] a finger is not exact

export function thingsOf(scene: Scene): Thing[] {
  const middle = (leaf: number[]) => ({x: (leaf[0] + leaf[2]) / 2, y: (leaf[1] + leaf[3]) / 2});
  return [
    ...scene.robots.map((r, i): Thing => ({kind: 'robot', name: String(i), x: r.x, y: r.y, th: r.th, reach: r.radius})),
    ...scene.people.map((p): Thing => ({kind: 'person', name: p.name, x: p.x, y: p.y, th: p.th, reach: p.radius})),
    ...scene.boxes.map((b): Thing => ({kind: 'box', name: b.name, x: b.x, y: b.y, th: b.th, reach: 0.3})),
    ...scene.doors.map((d): Thing => ({kind: 'door', name: d.name, ...middle(d.leaf), th: 0, reach: 0.4})),
  ];
}

export class SimulatorView {
  world?: World;
  scene?: Scene;
  chosen = 'robot 0';
  beams = true;
  wake = true;
  onChoose = (_: string) => {};
  // The picture moves when the robot comes near its edge (manual 3.4.4).
  follow = false;
  onFollow = (_: boolean) => {};
  onDrop = (_thing: Thing, _x: number, _y: number) => {};

  private context: CanvasRenderingContext2D;
  private scale = 1;          // [pixels/m]
  private origin = {x: 0, y: 0};
  private fitted = '';
  private ways = new Map<number, {x: number; y: number}[]>();
  private dragged?: {thing?: Thing; x: number; y: number; moved: boolean};

  constructor(private canvas: HTMLCanvasElement) {
    this.context = canvas.getContext('2d')!;
    new ResizeObserver(() => { this.fitted = ''; this.draw(); }).observe(canvas);
    canvas.addEventListener('pointerdown', event => this.press(event));
    canvas.addEventListener('mousedown', event => event.button === 1 && event.preventDefault());   // no scrolling by it
    canvas.addEventListener('pointermove', event => this.move(event));
    canvas.addEventListener('pointerup', event => this.release(event));
    canvas.addEventListener('pointercancel', () => { this.dragged = undefined; });
    canvas.addEventListener('wheel', event => {
      event.preventDefault();
      this.zoom(event.deltaY < 0 ? 1.2 : 1 / 1.2, event.offsetX, event.offsetY);
    }, {passive: false});
  }

  setWorld(world: World) {
    this.world = world;
    this.ways.clear();
    this.fitted = '';
    this.draw();
  }
  setScene(scene: Scene) {
    this.scene = scene;
    scene.robots.forEach((robot, i) => {
      const way = this.ways.get(i) ?? [];
      const last = way[way.length - 1];
      if (!last || Math.hypot(last.x - robot.x, last.y - robot.y) > 0.03) way.push({x: robot.x, y: robot.y});
      if (way.length > longestWake) way.shift();
      this.ways.set(i, way);
    });
    if (this.follow && !this.dragged) this.keepInside();
    this.draw();
  }
  // The chosen robot, else the first one, comes to the middle. The robot itself stays where it is.
  recenter() {
    const robot = this.robot();
    if (robot) this.center(robot.x, robot.y);
  }
  setFollow(follow: boolean) {
    this.follow = follow;
    if (follow) this.recenter();
    this.onFollow(follow);
  }
  clearWake() {
    this.ways.clear();
    this.draw();
  }
  zoom(factor: number, x = this.canvas.clientWidth / 2, y = this.canvas.clientHeight / 2) {
    this.origin = {x: x + (this.origin.x - x) * factor, y: y + (this.origin.y - y) * factor};
    this.scale *= factor;
    this.draw();
  }
  fit() {
    this.fitted = '';
    this.setFollow(false);
    this.draw();
  }

  private robot(): Robot | undefined {
    const [kind, name] = this.chosen.split(' ');
    return this.scene?.robots[kind === 'robot' ? Number(name) : 0] ?? this.scene?.robots[0];
  }
  private center(x: number, y: number) {
    this.origin = {x: this.canvas.clientWidth / 2 - x * this.scale, y: this.canvas.clientHeight / 2 + y * this.scale};
    this.draw();
  }
  private keepInside() {
    const robot = this.robot();
    if (!robot) return;
    const {clientWidth: width, clientHeight: height} = this.canvas;
    const far = (at: number, size: number) => Math.min(at, size - at) < nearEdge * size;
    if (far(this.origin.x + robot.x * this.scale, width) || far(this.origin.y - robot.y * this.scale, height)) this.center(robot.x, robot.y);
  }

  private place(event: PointerEvent) {
    return {x: (event.offsetX - this.origin.x) / this.scale, y: (this.origin.y - event.offsetY) / this.scale};
  }
  private press(event: PointerEvent) {
    if (!this.scene || event.button > 1) return;
    const at = this.place(event);
    if (event.button === 1) return this.center(at.x, at.y);   // manual 3.5
    let thing: Thing | undefined, best = Infinity;
    for (const each of thingsOf(this.scene)) {
      const far = Math.hypot(each.x - at.x, each.y - at.y) - each.reach;
      if (far < near && far < best) [thing, best] = [each, far];
    }
    if (thing) {
      this.chosen = `${thing.kind} ${thing.name}`;
      this.onChoose(this.chosen);
    }
    this.dragged = {thing, ...at, moved: false};
    this.canvas.setPointerCapture(event.pointerId);
    this.draw();
  }
  private move(event: PointerEvent) {
    if (!this.dragged) return;
    if (this.dragged.thing) {
      const at = this.place(event);
      this.dragged = {...this.dragged, ...at, moved: true};
    } else {
      if (this.follow) this.setFollow(false);
      this.origin.x += event.movementX;
      this.origin.y += event.movementY;
    }
    this.draw();
  }
  private release(event: PointerEvent) {
    const dragged = this.dragged;
    this.dragged = undefined;
    if (dragged?.thing && (dragged.moved || dragged.thing.kind === 'door')) {
      const at = this.place(event);
      this.onDrop(dragged.thing, at.x, at.y);
    }
    this.draw();
  }

  private draw() {
    const {canvas, context: c, world} = this;
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const style = getComputedStyle(document.documentElement);
    const color = (name: string) => style.getPropertyValue(`--map-${name}`).trim();
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.fillStyle = color('seen');
    c.fillRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    if (!world) return;
    if (this.fitted !== world.world) {
      this.fitted = world.world;
      this.scale = 0.95 * Math.min(canvas.clientWidth / world.width, canvas.clientHeight / world.height);
      this.origin = {x: (canvas.clientWidth - world.width * this.scale) / 2, y: (canvas.clientHeight + world.height * this.scale) / 2};
    }
    const px = (x: number) => this.origin.x + x * this.scale, py = (y: number) => this.origin.y - y * this.scale;
    const line = (l: number[]) => { c.beginPath(); c.moveTo(px(l[0]), py(l[1])); c.lineTo(px(l[2]), py(l[3])); c.stroke(); };
    const disc = (x: number, y: number, r: number) => { c.beginPath(); c.arc(px(x), py(y), Math.max(1.5, r * this.scale), 0, 2 * Math.PI); };
    c.lineWidth = 1.5;
    c.strokeStyle = color('wall');
    world.walls.forEach(line);
    for (const post of world.posts) {
      c.fillStyle = post.color || color('wall');
      disc(post.x, post.y, post.radius);
      c.fill();
    }
    const scene = this.scene;
    if (!scene) return;
    c.lineWidth = 3;
    for (const door of scene.doors) {
      c.strokeStyle = color(door.open ? 'door' : 'closed');
      line(door.leaf);
    }
    c.lineWidth = 1.5;
    for (const box of scene.boxes) {
      c.strokeStyle = color('corridor');
      c.beginPath();
      box.corners.forEach(([x, y], i) => (i ? c.lineTo(px(x), py(y)) : c.moveTo(px(x), py(y))));
      c.closePath();
      c.stroke();
    }
    if (this.wake)
      for (const way of this.ways.values()) {
        c.strokeStyle = color('wake');
        c.beginPath();
        way.forEach((p, i) => (i ? c.lineTo(px(p.x), py(p.y)) : c.moveTo(px(p.x), py(p.y))));
        c.stroke();
      }
    for (const person of scene.people) {
      c.fillStyle = color('person');
      disc(person.x, person.y, person.radius);
      c.fill();
      if (person.arm) {
        c.strokeStyle = color('person');
        c.lineWidth = 4;
        line(person.arm);
      }
    }
    for (const robot of scene.robots) {
      if (this.beams) {
        c.strokeStyle = color('echo');
        c.lineWidth = 1;
        robot.sonars.forEach(line);
      }
      c.fillStyle = color('robot');
      c.strokeStyle = color('robot-edge');
      c.lineWidth = 2;
      disc(robot.x, robot.y, robot.radius);
      c.fill();
      line([robot.x, robot.y, robot.x + robot.radius * Math.cos(robot.th), robot.y + robot.radius * Math.sin(robot.th)]);
      if (robot.head !== undefined) {
        const way = robot.radius + 0.6, th = robot.th + robot.head;
        c.strokeStyle = color('person');
        c.setLineDash([5, 4]);
        line([robot.x, robot.y, robot.x + way * Math.cos(th), robot.y + way * Math.sin(th)]);
        c.setLineDash([]);
      }
    }
    const chosen = thingsOf(scene).find(t => `${t.kind} ${t.name}` === this.chosen);
    const mark = (x: number, y: number, r: number) => {
      c.strokeStyle = color('goal');
      c.lineWidth = 2;
      c.setLineDash([5, 4]);
      disc(x, y, r + 0.12);
      c.stroke();
      c.setLineDash([]);
    };
    if (chosen) mark(chosen.x, chosen.y, chosen.reach);
    if (this.dragged?.thing && this.dragged.moved) mark(this.dragged.x, this.dragged.y, this.dragged.thing.reach);
  }
}
