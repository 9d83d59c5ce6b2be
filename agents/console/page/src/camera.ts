// The camera's pictures: connections of their own, which are there while the pictures are shown. Each has its share of
// the pictures: where one waits for what was lost on its way, the others go on.
import {socketOf} from './address';
import {compose, inverse} from './geometry';
import type {Link} from './link';
import type {Pose, RobotDescription, RobotState} from './types';

export interface Picture {
  image: ImageBitmap;
  camera: string;
  captured: number;   // [ms] performance.now()
  columns: number;
  rows: number;
  field: number;      // [rad] from side to side [0: not known]
  x: number;          // of the lens in the robot; th: of the picture's middle
  y: number;
  th: number;
  height: number;     // [m] of the lens [0: not known]
}

const retry = 1000;             // [ms]
const lanes = 3;
const usualField = Math.PI / 3;
const sonarHeight = 0.25;       // [m] of a robot's sonars, about

export class Camera {
  picture?: Picture;
  private sockets: WebSocket[] = [];
  private ticket = `${Math.random()}`;
  private wanted = true;

  constructor(private link: Link, private came: () => void) {
    for (let lane = 0; lane < lanes; ++lane) this.open(lane);
  }

  close() {
    this.wanted = false;
    for (const socket of this.sockets) socket.close();
  }

  private open(lane: number) {
    if (!this.wanted) return;
    const socket = this.sockets[lane] = socketOf('saphira.pictures');
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => socket.send(JSON.stringify({type: 'hello', key: this.link.key, name: this.link.operator, ticket: this.ticket}));
    socket.onmessage = event => void this.take(socket, event.data as ArrayBuffer);
    socket.onclose = () => setTimeout(() => this.open(lane), retry);
  }

  // A line of JSON, and the JPEG behind it. A picture that another one has overtaken is not shown.
  private async take(socket: WebSocket, message: ArrayBuffer) {
    const bytes = new Uint8Array(message), end = bytes.indexOf(10);
    if (end < 0) return;
    const {number, now, age, ...about} = JSON.parse(new TextDecoder().decode(bytes.subarray(0, end)));
    const captured = this.link.when(now - age);
    try {
      const image = await createImageBitmap(new Blob([bytes.subarray(end + 1)], {type: 'image/jpeg'}));
      if (this.picture && captured < this.picture.captured) {
        image.close();
      } else {
        this.picture?.image.close();
        this.picture = {...about, image, captured};
        this.came();
      }
    } catch {
      // It is no JPEG: the next one may be.
    }
    if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify({type: 'ack', frame: number}));
  }
}

// The picture, the direction that the robot points in, and the sonars' echoes where they are in it.
export function drawPicture(canvas: HTMLCanvasElement, {image, columns, rows, field, x, y, th, height}: Picture, link: Link) {
  if (canvas.width !== columns || canvas.height !== rows) [canvas.width, canvas.height] = [columns, rows];
  const paint = canvas.getContext('2d')!;
  paint.drawImage(image, 0, 0, columns, rows);
  const focal = columns / 2 / Math.tan((field || usualField) / 2);
  const lens = inverse({x, y, th});
  // Of a place in the robot's frame, at a height above the floor.
  const pixel = (at: Pose, above: number) => {
    const seen = compose(lens, at);
    return seen.x > 0.05 && {x: columns / 2 - focal * seen.y / seen.x, y: rows / 2 + focal * ((height || 1) - above) / seen.x};
  };
  const line = (points: [number, number][], color: string, width: number) => {
    paint.strokeStyle = color;
    paint.lineWidth = width;
    paint.beginPath();
    for (const [px, py] of points) paint.lineTo(px, py);
    paint.stroke();
  };
  const ahead = pixel({x: 100, y: 0, th: 0}, height || 1);
  if (ahead && ahead.x > 0 && ahead.x < columns)
    for (const [color, width] of [['#0008', 4], ['#fffc', 2]] as const) {
      line([[ahead.x - 12, ahead.y], [ahead.x + 12, ahead.y]], color, width);
      line([[ahead.x, ahead.y - 12], [ahead.x, ahead.y + 12]], color, width);
    }
  const sonars = link.data<RobotDescription>('robot/description')?.sonars ?? [];
  paint.font = '11px system-ui, sans-serif';
  paint.textAlign = 'center';
  for (const {sonar, range, echo} of link.data<RobotState>('robot/state')?.sonars ?? []) {
    const from = sonars.find(each => each.sonar === sonar)?.pose_in_robot;
    if (!echo || !from) continue;
    const at = compose(from, {x: range, y: 0, th: 0}), place = pixel(at, sonarHeight);
    if (!place || place.x < 0 || place.x > columns) continue;
    const below = Math.min(place.y, rows - 6), distance = `${Math.hypot(at.x, at.y).toFixed(1)} m`;
    for (const [color, width] of [['#000a', 5], ['#ffb84d', 3]] as const) line([[place.x - 14, below], [place.x + 14, below]], color, width);
    paint.strokeStyle = '#000c';
    paint.fillStyle = '#fff';
    paint.lineWidth = 3;
    paint.strokeText(distance, place.x, below - 5);
    paint.fillText(distance, place.x, below - 5);
  }
}
