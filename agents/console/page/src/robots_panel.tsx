// All robots on the bus: their states, drivers and reasons, a stop for each and for all, the way to each one's page.
import {useEffect} from 'preact/hooks';
import type {Link} from './link';
import {wayTo} from './robots';
import type {ConsoleInfo, RobotRow} from './types';
import {driverWords, forPage} from './words';

export const robotsOf = (link: Link) => link.data<RobotRow[]>('robots') ?? [];

const doesWords = {silent: 'not heard', stopped: 'emergency stop', drives: 'drives', stands: 'stands'};
const doesChips = {silent: 'bad', stopped: 'bad', drives: 'good', stands: ''};

export function Robots({link, gone, close}: {link: Link; gone: boolean; close: () => void}) {
  // Anew after a lost connection.
  useEffect(() => {
    link.send({type: 'robots', shown: true});
    return () => { link.send({type: 'robots', shown: false}); };
  }, [link.id]);
  const stop = (robot: string) => link.ask({type: 'stop_robots', robot}).then(answer => link.note(answer.text, answer.well));
  const rows = robotsOf(link), host = link.data<ConsoleInfo>('console')?.host ?? '';
  const title = link.mayDrive ? 'emergency stop: until Reset' : 'ends whatever moves it; the emergency stop needs the key';
  // At the touch; the click is the keyboard's.
  const press = (robot: string) => ({title, onPointerDown: () => stop(robot), onClick: (e: MouseEvent) => { if (e.detail === 0) void stop(robot); }});
  return <section class="robots" aria-label="Robots">
    <div class="row"><h2 class="grow">Robots</h2>
      <button class="estop" {...press('')}>STOP ALL</button>
      <button class="plain" aria-label="Close the list of robots" onClick={close}>×</button></div>
    <ul class="cards">{rows.map(row => {
      const {address, why} = row.own ? {address: '', why: ''} : wayTo(row, location, host);
      const does = gone ? 'silent' : row.does;
      return <li key={row.name} class="card"><div class="row top">
        <div class="grow"><div class="row"><strong>{address ? <a href={address}>{row.name}</a> : row.name}</strong>
          <span class={`chip ${doesChips[does]}`}>{row.trouble ? 'not joined' : doesWords[does]}</span>
          {row.own && <span class="chip">this page</span>}
          {row.battery !== undefined && <span class="small faint">{row.battery.toFixed(1)} V</span>}</div>
          <p class="small">{row.trouble || <>{driverWords[row.role ?? ''] ?? 'nothing is known of its driver'}{row.who && ` (${row.who})`}{row.why && `: ${forPage(row.why)}`}</>}</p>
          {why && <p class="small faint">{why}</p>}</div>
        <button class="estop" aria-label={`Stop ${row.name}`} {...press(row.name)}>STOP</button></div></li>;
    })}</ul>
  </section>;
}
