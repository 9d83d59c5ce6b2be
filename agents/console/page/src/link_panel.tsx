// The link over the last minutes, as small charts.
import {type Second, span} from './history';
import type {Link} from './link';
import type {Seen} from './types';
import {seconds} from './words';

const height = 36;

// Bars of one value a second, against the largest; grey where nothing came.
function Chart({name, series, of, floor, unit}: {name: string; series: (Second | undefined)[]; of: (s: Second) => number; floor: number; unit: (value: number) => string}) {
  const values = series.map(s => s && s.heard + s.trip > 0 ? of(s) : undefined), known = values.filter(v => v !== undefined);
  const most = Math.max(floor, ...known), newest = known.length ? unit(known[known.length - 1]) : 'nothing', worst = known.length ? unit(Math.max(...known)) : '';
  const bars = values.map((v, i) => v === undefined ? '' : `M${i + 0.5} ${height}V${(height - Math.max(v > 0 ? 1 : 0, v / most * height)).toFixed(1)}`).join('');
  const first = values.findIndex(v => v !== undefined), gaps = values.map((v, i) => v === undefined && first >= 0 && i > first ? `M${i + 0.5} 0V${height}` : '').join('');
  return <figure><figcaption><span>{name}</span><span>{newest}{worst && <span class="faint">, at most {worst}</span>}</span></figcaption>
    <svg viewBox={`0 0 ${span} ${height}`} preserveAspectRatio="none" role="img" aria-label={`${name}: ${newest}, at most ${worst}`}>
      <rect class="chart-ground" width={span} height={height} /><path class="chart-gap" d={gaps} /><path class="chart-bars" d={bars} /></svg></figure>;
}

export function LinkHistory({link, seen, close}: {link: Link; seen: Seen; close: () => void}) {
  const series = link.history.series(performance.now()), ms = (v: number) => v < 1000 ? `${Math.round(v)} ms` : seconds(v);
  const heard = series.filter(s => s?.heard), sum = (of: (s: Second) => number) => heard.reduce((all, s) => all + of(s!), 0);
  const silent = series.slice(Math.max(0, series.findIndex(s => s))).filter(s => !s?.heard).length;
  return <section class="history" aria-label="The link over the last minutes">
    <div class="row"><h2 class="grow">The link over the last {span / 60} minutes</h2><button class="plain" aria-label="Close the link's history" onClick={close}>×</button></div>
    <div class="charts">
      <Chart name="Age of the picture" series={series} of={s => s.age} floor={100} unit={ms} />
      <Chart name="There and back" series={series} of={s => s.trip} floor={100} unit={ms} />
      <Chart name="Cycles that did not come" series={series} of={s => 100 * s.missed / Math.max(1, s.missed + s.heard)} floor={20} unit={v => `${Math.round(v)}%`} />
      <Chart name="The robot's own packets a second" series={series} of={s => s.packets} floor={10} unit={v => `${v}`} />
    </div>
    <p class="small">{silent > 0 && heard.length > 0 && `${silent} s without news. `}{sum(s => s.missed)} of {sum(s => s.missed + s.heard)} cycles did not come; a slow link leaves some out, so that the newest is not delayed.
      {' '}The robot's own link had {sum(s => s.bad)} bad packets.{seen.state === 'live' || heard.length === 0 ? '' : ' Nothing comes now.'}</p>
  </section>;
}
