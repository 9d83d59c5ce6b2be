// The drawings of programs (topic drawings), as lines and labels.
import type {Drawing} from './types';

type Point = [number, number];
export interface Pen {
  line(points: Point[]): void;
  label(text: string, x: number, y: number): void;
  head: number;              // [m] of an arrow
}

export function drawShape(d: Drawing, pen: Pen) {
  const points = d.points.map(p => [p.x, p.y] as Point);
  const pairs: [Point, Point][] = [];
  for (let i = 0; i + 1 < points.length; i += 2) pairs.push([points[i], points[i + 1]]);
  switch (d.shape) {
    case 'DRAWING_POINTS':
      for (const p of points) pen.line([p, p]);
      break;
    case 'DRAWING_LINE':
      pen.line(points);
      break;
    case 'DRAWING_RECTANGLE':
      for (const [[x0, y0], [x1, y1]] of pairs) pen.line([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]]);
      break;
    case 'DRAWING_ARROW':
      for (const [[x0, y0], [x1, y1]] of pairs) {
        const th = Math.atan2(y1 - y0, x1 - x0);
        const wing = (a: number): Point => [x1 - pen.head * Math.cos(th + a), y1 - pen.head * Math.sin(th + a)];
        pen.line([[x0, y0], [x1, y1]]);
        pen.line([wing(0.5), [x1, y1], wing(-0.5)]);
      }
      break;
    case 'DRAWING_TEXT':
      if (points.length > 0) pen.label(d.text, points[0][0], points[0][1]);
  }
}
