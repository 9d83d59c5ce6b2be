// run pictures [SECONDS]: how many pictures of a camera a page gets over good and bad links, how old they are when they
// have come, and how large. The robot is the simulator's; a second page is on a good link all the time.
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {link} from './link.mjs';
import {end, sleep, start, until} from './processes.mjs';
import {socketTo} from './socket.mjs';

const time = Number(process.argv[2] ?? 15), settling = 5;   // [s]
const links = [{}, {delay: 50, spread: 10}, {delay: 100, loss: 0.05}, {delay: 250, spread: 50, loss: 0.05},
  {delay: 250, spread: 50, loss: 0.05, rate: 250e3}, {delay: 50, rate: 30e3}];

const folder = mkdtempSync(join(tmpdir(), 'saphira-pictures-')), robot = `pictures-${process.pid}`;
const sockets = {robot: join(folder, 'robot'), camera: join(folder, 'camera')};
const children = [start('saphira-sim', '--socket', sockets.robot, '--camera-socket', sockets.camera),
  start('saphira-bridge', '--robot', robot, '--link', sockets.robot),
  start('saphira-camera', '--robot', robot, '--socket', sockets.camera),
  start('saphira-console', '--robot', robot, '--port', '0')];
let told = '';
children.at(-1).stdout.on('data', data => { told += data; });
const [, port, key] = await until('the address', () => told.match(/http:\/\/localhost:(\d+)\/#(\w+)/));

// A page that shows the camera. Age [s]: the gateway's, and the way of the picture by our clock.
async function page(by, delay) {
  const seen = [];
  const headers = {Host: `localhost:${port}`, Origin: `http://localhost:${port}`};
  const socket = await socketTo(by, 'saphira.pictures', headers);
  socket.take = bytes => {
    const line = bytes.indexOf(10), {number, age, cycle} = JSON.parse(bytes.subarray(0, line).toString());
    seen.push({at: performance.now(), age, cycle, size: bytes.length - line - 1});
    socket.say({type: 'ack', frame: number});
  };
  socket.say({type: 'hello', key, name: `by ${delay} ms`});
  return {seen, close: () => socket.socket.destroy()};
}
const quantile = (values, share) => values.sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];

console.log('| link, each way | pictures a second | age [s]: half of them, 95 % | kB | beside it, on a good link |\n| --- | --- | --- | --- | --- |');
for (const bad of links) {
  const far = await link(Number(port), bad), near = await page(Number(port), 0), one = await page(far.port, bad.delay ?? 0);
  await sleep(1000 * settling);
  const from = [near.seen.length, one.seen.length];
  await sleep(1000 * time);
  const [good, seen] = [near.seen.slice(from[0]), one.seen.slice(from[1])];
  // Both pages hear of the same cycle; the good link takes no time.
  const captured = new Map(near.seen.map(each => [each.cycle, each.at - 1000 * each.age]));
  const ages = seen.filter(each => captured.has(each.cycle)).map(each => (each.at - captured.get(each.cycle)) / 1000);
  const name = [`${bad.delay ?? 0}${bad.spread ? ` ± ${bad.spread}` : ''} ms`, bad.loss && `${100 * bad.loss} % lost`, bad.rate && `${bad.rate / 1000} kB/s`];
  console.log(`| ${name.filter(Boolean).join(', ')} | ${(seen.length / time).toFixed(1)} | ${quantile(ages, 0.5)?.toFixed(2)}, ${quantile(ages, 0.95)?.toFixed(2)} | ${(seen.reduce((sum, each) => sum + each.size, 0) / seen.length / 1000).toFixed(1)} | ${(good.length / time).toFixed(1)} |`);
  near.close();
  one.close();
}
for (const child of children.reverse()) await end(child);
rmSync(folder, {recursive: true, force: true});
process.exit(0);
