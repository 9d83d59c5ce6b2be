import {useEffect, useRef, useState} from 'preact/hooks';
import {Camera, drawPicture} from './camera';
import type {Link} from './link';
import type {RobotDescription, ServiceStatus} from './types';
import {seconds} from './words';

const wordsPeriod = 200;   // [ms]
const old = 1500;          // [ms]

// The camera's program; none: there is no camera.
export const cameraOf = (link: Link) => link.all<ServiceStatus>('system/status').find(([, {data}]) => data.name === 'camera')?.[1].data;

export function CameraPanel({link, close}: {link: Link; close: () => void}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const camera = useRef<Camera>();
  const [, redraw] = useState(0);
  useEffect(() => {
    const one = camera.current = new Camera(link, () => drawPicture(canvas.current!, one.picture!, link));
    const timer = setInterval(() => redraw(n => n + 1), wordsPeriod);
    return () => {
      clearInterval(timer);
      one.close();
    };
  }, []);
  const picture = camera.current?.picture, age = picture ? performance.now() - picture.captured : Infinity;
  const words = picture ? `${seconds(Math.max(0, age))} old` : cameraOf(link)?.reason.replace(/^off:.*/, '') || 'waiting for a picture …';
  // A head that turns is turned by dragging the picture, by keys, or by words ("look left").
  const turns = link.mayDrive && (link.data<RobotDescription>('robot/description')?.head_reach ?? 0) > 0;
  const turn = (by: number) => turns && picture && link.ask({type: 'goal', words: `look angle=${(picture.th + by).toFixed(3)}`})
    .then(answer => answer.well || link.note(answer.text, false));
  const from = useRef(0);
  return <figure class="camera" aria-label="Camera">
    <canvas ref={canvas} class={`${age > old ? 'stale' : ''} ${turns ? 'turns' : ''}`} width="320" height="240" role="img" tabIndex={turns ? 0 : -1}
            title={turns ? 'drag it to turn the camera' : ''}
            onPointerDown={e => { from.current = e.offsetX; (e.target as Element).setPointerCapture(e.pointerId); }}
            onPointerUp={e => { const by = e.offsetX - from.current; if (Math.abs(by) > 10) void turn(by / canvas.current!.clientWidth * (picture?.field || 1)); }}
            onKeyDown={e => { if (e.key === 'ArrowLeft' || e.key === 'ArrowRight') void turn(e.key === 'ArrowLeft' ? 0.2 : -0.2), e.preventDefault(); }}
            aria-label={picture ? `what the camera ${picture.camera} sees, with the sonars' echoes` : 'no picture yet'} />
    <figcaption class={age > old ? 'bad' : ''}>{words}</figcaption>
    <button class="plain" aria-label="Close the camera" onClick={close}>×</button>
  </figure>;
}
