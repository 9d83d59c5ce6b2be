// The legend of the picture: each drawn thing with its sign. The colours are those of view.ts.
import type {ComponentChildren} from 'preact';
import {useRef, useState} from 'preact/hooks';
import {zoneColor} from './view';

const ink = (name: string) => `var(--map-${name})`;
const line = (color: string, width: number, dash = '') =>
  <line x1="2" y1="8" x2="32" y2="8" stroke={color} stroke-width={width} stroke-dasharray={dash} />;
const cross = (color: string) =>
  <g stroke={color} stroke-width="2" fill="none"><circle cx="17" cy="8" r="4" /><path d="M17 0V5M17 11V16M9 8H14M20 8H25" /></g>;
const zone = (rule: string, arrow = false) => <g stroke={zoneColor[rule]}>
  <rect x="3" y="2" width="28" height="12" fill={zoneColor[rule]} fill-opacity=".2" stroke-width="1.5" stroke-dasharray="6 4" />
  {arrow && <path d="M9 8H25M20 4 25 8 20 12" fill="none" stroke-width="2" />}</g>;

const signs: [string, [ComponentChildren, string][]][] = [
  ['Robot', [
    [<g fill={ink('robot')}><circle cx="15" cy="8" r="6" /><path d="M18 3 25 8 18 13Z" /></g>, 'the robot and its nose'],
    [<ellipse cx="17" cy="8" rx="13" ry="6" fill={ink('uncertain')} fill-opacity=".18" stroke={ink('uncertain')} stroke-opacity=".7" />, 'where it may be on the map (two sigma)'],
    [<ellipse cx="17" cy="8" rx="13" ry="6" fill="none" stroke={ink('uncertain')} stroke-width="1.5" stroke-dasharray="4 4" />, 'interrupted: not confirmed yet'],
    [<g stroke={ink('muted')} stroke-dasharray="4 3"><circle cx="17" cy="8" r="6" fill="none" stroke-width="1.5" /></g>, 'lost: the robot at a guess'],
    [<path d="M2 8H24" stroke={ink('goal')} stroke-width="2.5" />, 'its speed; to the side: its turn'],
    [<rect x="11" y="5" width="12" height="6" fill="none" stroke={ink('goal')} stroke-width="1.5" />, 'the heading that it turns to'],
    [line(ink('person'), 1.5, '5 4'), 'the direction of its cameras'],
    [<g fill={ink('wake')}><circle cx="7" cy="8" r="2" /><circle cx="17" cy="8" r="2" /><circle cx="27" cy="8" r="2" /></g>, 'its wake of 10 s'],
    [line('rgb(70,130,180)', 2), 'the route'],
    [cross(ink('goal')), 'a goal'],
    [cross(ink('text')), 'the place that you have chosen'],
  ]],
  ['What it perceives', [
    [<g fill="none" stroke={ink('echo')} stroke-width="1.2"><rect x="6" y="5" width="6" height="6" /><rect x="22" y="6.5" width="3" height="3" /></g>, 'a sonar echo; larger: a new one'],
    [line(ink('percept'), 4), 'a wall'],
    [<path d="M2 4H32M2 12H32" stroke={ink('percept')} stroke-width="1.5" stroke-dasharray="3 4" />, 'a corridor'],
    [<rect x="15" y="1" width="5" height="14" fill="none" stroke={ink('percept')} stroke-width="2" />, 'a door or a junction'],
    [<rect x="5" y="2" width="24" height="12" fill="none" stroke={ink('percept')} />, 'a sensitive area of a behavior'],
    [<g><circle cx="11" cy="8" r="5" fill={ink('person')} /><path d="M11 8H30" stroke={ink('person')} stroke-width="3" /></g>, 'a person; with an arm: who points'],
    [<rect x="3" y="2" width="28" height="12" fill={ink('seen')} stroke={ink('muted')} stroke-width=".5" />, 'free floor (occupancy grid)'],
    [<rect x="3" y="2" width="28" height="12" fill={ink('muted')} />, 'something stands there (occupancy grid)'],
  ]],
  ['Map', [
    [line(ink('wall'), 2.5), 'a wall'],
    [line(ink('wall'), 2.5, '4 4'), 'interrupted: learned by the robot'],
    [line(ink('door'), 4), 'a door or an opening'],
    [line(ink('closed'), 4), 'a door that was closed'],
    [<path d="M2 4H32M2 12H32" stroke={ink('corridor')} stroke-dasharray="8 5" />, 'a corridor or a lane'],
    [<rect x="5" y="2" width="24" height="12" fill="none" stroke={ink('corridor')} />, 'a room'],
    [<path d="M14 8H20M17 5V11" stroke={ink('corridor')} stroke-width="1.5" />, 'another place'],
    [zone('ZONE_KEEP_OUT'), 'a zone to keep out of'],
    [zone('ZONE_SLOW'), 'a zone to go slowly in'],
    [zone('ZONE_ONE_WAY', true), 'a one-way zone'],
    [zone('ZONE_PREFERRED'), 'a preferred zone'],
  ]],
];

export function Legend() {
  const [open, setOpen] = useState(false);
  const button = useRef<HTMLButtonElement>(null);
  const keys = (event: KeyboardEvent) => {
    if (event.key !== 'Escape' || !open) return;
    event.stopPropagation();
    setOpen(false);
    button.current?.focus();
  };
  return <div class="legend" onKeyDown={keys}>
    <button ref={button} aria-label="Legend" aria-expanded={open} aria-controls="legend" title="what is drawn, and how" onClick={() => setOpen(!open)}>
      <span class="word" aria-hidden="true">Legend</span><span class="sign" aria-hidden="true">?</span></button>
    {/* It may be scrolled by the keyboard, too. */}
    <div id="legend" role="region" aria-label="Legend" tabIndex={0} hidden={!open}>
      {open && signs.map(([kind, all]) => <section key={kind}><h2>{kind}</h2>
        <ul>{all.map(([sign, words]) => <li key={words}><svg viewBox="0 0 34 16" width="34" height="16" aria-hidden="true">{sign}</svg>{words}</li>)}</ul></section>)}
      {open && <p class="small faint">Programs draw in colours of their own.</p>}
    </div>
  </div>;
}
