// Driving by a relay: the gateway has dialled out, and the operator knows the relay's address alone. What
// the operator and the gateway say is encrypted between them. What happened is read from the simulator's
// trace. It needs no browser: this is the page's side of the two connections.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import https from 'node:https';
import net from 'node:net';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import tls from 'node:tls';
import {end, ended, freePorts, output, sleep, start, trace, until} from './processes.mjs';
import {socketTo} from './socket.mjs';

const token = '0123456789abcdef0123456789abcdef';
const folder = mkdtempSync(join(tmpdir(), 'saphira-relay-'));
const file = name => join(folder, name);
let simulator, bridge, gateway, relay, ports, key, ann;

function startRelay() {
  return start('saphira-relay', '--robots', file('robots'), '--dial-port', `${ports[0]}`, '--listen', '127.0.0.1',
    '--certificate', file('relay.pem'), '--certificate-key', file('relay.key'));
}
const gateways = [];
function startGateway(robot, secret, ...more) {
  gateways.push(start('saphira-console', '--robot', robot, '--port', '0', '--certificate', file('robot.pem'),
    '--certificate-key', file('robot.key'), '--dial', `wss://localhost:${ports[0]}/pioneer`,
    '--dial-token-file', file(secret), ...(more.length > 0 ? more : ['--dial-authority', file('relay.pem')])));
  return gateways.at(-1);
}

const robot = `relay-${process.pid}`;
before(async () => {
  ports = await freePorts(2);
  for (const name of ['relay', 'robot'])
    execFileSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes',
      '-keyout', file(`${name}.key`), '-out', file(`${name}.pem`), '-days', '2', '-subj', '/CN=localhost',
      '-addext', 'subjectAltName=DNS:localhost'], {stdio: 'ignore'});
  writeFileSync(file('robots'), `pioneer ${ports[1]} ${token}\n`, {mode: 0o600});
  writeFileSync(file('token'), `${token}\n`, {mode: 0o600});
  writeFileSync(file('wrong'), 'x'.repeat(32), {mode: 0o600});
  const line = file('robot');
  simulator = start('saphira-sim', '--world', 'arena', '--socket', line, '--trace', file('trace.csv'));
  bridge = start('saphira-bridge', '--robot', robot, '--link', line);
});
after(async () => {
  ann?.end();   // a test that failed leaves her at the stick
  for (const child of [...gateways, relay, bridge, simulator]) await end(child);
  rmSync(folder, {recursive: true, force: true});
});

const {now, speed, stood} = trace(file('trace.csv'));

// The page's side, with a key held.
async function operator() {
  const headers = {Host: `localhost:${ports[1]}`, Origin: `https://localhost:${ports[1]}`};
  const trust = {ca: readFileSync(file('robot.pem')), servername: 'localhost'};
  const telemetry = await socketTo(ports[1], 'saphira.telemetry', headers, trust);
  const commands = await socketTo(ports[1], 'saphira.commands', headers, trust);
  for (const socket of [telemetry, commands]) socket.say({type: 'hello', key, name: 'ann'});
  const self = {telemetry, commands, velocity: 0, cycle: 0, control: {}};
  let number = 0;
  self.beat = setInterval(() => {
    for (const frame of telemetry.texts.splice(0)) {
      if (frame.seq !== undefined) telemetry.say({type: 'ack', frame: frame.seq});
      for (const {t, d} of frame.items ?? []) {
        if (t === 'robot/state') self.cycle = d.stamp.cycle;
        if (t === 'console/control') self.control = d;
      }
    }
    commands.texts.length = 0;
    commands.say({type: 'drive', number: ++number, at: performance.now() / 1000, active: self.velocity !== 0,
      velocity: self.velocity, rotation: 0, cycle: self.cycle});
  }, 50);
  self.end = () => {
    clearInterval(self.beat);
    telemetry.socket.destroy();
    commands.socket.destroy();
  };
  await until('control', async () => {
    if (self.control.name !== 'ann') commands.say({type: 'take', force: true});
    await sleep(200);
    return self.cycle > 0 && self.control.name === 'ann';
  });
  return self;
}
// A bridge that was held up has taken the grant away: the stick must be let go first.
async function drives(operator, velocity) {
  await until('it drives', async () => {
    operator.velocity = 0;
    await sleep(300);
    operator.velocity = velocity;
    for (const end = Date.now() + 2500; Date.now() < end; await sleep(50))
      if (speed() > 0.6 * Math.abs(velocity)) return true;
    return false;
  });
}
const answered = (headers = {}) => new Promise(resolve => {
  https.get({host: '127.0.0.1', port: ports[1], path: '/', servername: 'localhost', ca: readFileSync(file('robot.pem')),
    agent: false, headers: {Host: `localhost:${ports[1]}`, ...headers}}, response => {
    response.resume();
    resolve(response.statusCode);
  }).on('error', () => resolve(0));
});

test('a gateway with another token is not let in, and says so', async () => {
  relay = startRelay();
  await until('the relay', () => output().includes('listens for robots'));
  gateway = startGateway(robot, 'wrong');
  await until('the refusal', () => output().includes('it has no robot pioneer with the token of --dial-token-file'));
  await until('the other side', () => /127\.0\.0\.1 is refused: its token is another one than that of pioneer/.test(output()));
  assert.doesNotMatch(output(), /has dialled in/);
  gateway.kill('SIGTERM');
  await ended(gateway);
});

test('a gateway that does not trust the relay is named on both sides', async () => {
  gateway = startGateway(robot, 'token', '--dial-authority', file('robot.pem'));
  await until('the refusal', () => /its certificate is not accepted: .*; --dial-authority has to be/.test(output()));
  await until('the other side', () => /127\.0\.0\.1 does not accept this relay's certificate/.test(output()));
  gateway.kill('SIGTERM');
  await ended(gateway);
});

test('the page comes by the relay, end to end encrypted', async () => {
  gateway = startGateway(robot, 'token');
  key = (await until('the address', () => output().match(new RegExp(`open https://localhost:${ports[1]}/#(\\w+)`))))[1];
  assert.equal(await answered(), 200);
  assert.equal(await answered({Origin: 'https://evil.example'}), 403);
  // A browser offers HTTP/2, of which the gateway has no WebSockets.
  const chosen = await new Promise((resolve, reject) => {
    const socket = tls.connect({host: '127.0.0.1', port: ports[1], servername: 'localhost',
      ca: readFileSync(file('robot.pem')), ALPNProtocols: ['h2', 'http/1.1']}, () => {
      resolve(socket.alpnProtocol);
      socket.destroy();
    }).on('error', reject);
  });
  assert.equal(chosen, 'http/1.1');
  // Without TLS nothing answers.
  const plain = net.connect(ports[1], '127.0.0.1');
  plain.on('error', () => {}).write('GET / HTTP/1.1\r\nHost: localhost\r\n\r\n');
  const said = await new Promise(resolve => {
    let text = '';
    plain.on('data', data => { text += data; }).on('close', () => resolve(text));
  });
  assert.doesNotMatch(said, /200 OK/);
});

test('the list of robots leads to the page by the relay', async () => {
  const other = start('saphira-console', '--robot', `${robot}-other`, '--port', '0');
  let told = '';
  other.stdout.on('data', data => { told += data; });
  const [, port, secret] = await until('its address', () => told.match(/http:\/\/localhost:(\d+)\/#(\w+)/));
  const headers = {Host: `localhost:${port}`, Origin: `http://localhost:${port}`};
  const [telemetry, commands] = [await socketTo(port, 'saphira.telemetry', headers), await socketTo(port, 'saphira.commands', headers)];
  for (const socket of [telemetry, commands]) socket.say({type: 'hello', key: secret, name: 'bob'});
  commands.say({type: 'robots', shown: true});
  await until('the address in the list', () => telemetry.texts.splice(0).some(frame => {
    if (frame.seq !== undefined) telemetry.say({type: 'ack', frame: frame.seq});
    return frame.items?.some(({t, d}) => t === 'robots'
      && d.some(row => row.name === robot && row.address === `https://localhost:${ports[1]}/`));
  }));
  for (const socket of [telemetry, commands]) socket.socket.destroy();
  await end(other);
});

test('nobody who comes by the relay is a neighbour: without the key they see nothing', async () => {
  const headers = {Host: `localhost:${ports[1]}`, Origin: `https://localhost:${ports[1]}`};
  const stranger = await socketTo(ports[1], 'saphira.commands', headers,
    {ca: readFileSync(file('robot.pem')), servername: 'localhost'});
  stranger.say({type: 'hello', key: '', name: 'eve'});
  const hello = await until('an answer', () => stranger.texts.find(text => text.type === 'hello'));
  assert.equal(hello.may_watch, false);
  assert.equal(hello.may_drive, false);
  stranger.socket.destroy();
});

test('it is driven by the relay; the relay hangs, and dies: the robot stands, and it all comes back', async () => {
  ann = await operator();
  await drives(ann, 0.3);
  let from = now();
  relay.kill('SIGSTOP');
  const hung = await until('it stands while the relay hangs', () => stood(from));
  relay.kill('SIGCONT');
  ann.end();

  ann = await operator();
  await drives(ann, 0.3);
  from = now();
  relay.kill('SIGKILL');
  const died = await until('it stands when the relay has died', () => stood(from));
  ann.end();
  console.log(`until it stands: ${hung} s when the relay hangs, ${died} s when it dies`);
  await ended(relay);
  await sleep(500);
  assert.ok(speed() < 0.01);

  const before = output().length;
  relay = startRelay();
  await until('the gateway dials again', () => output().slice(before).includes('has dialled in'));
  ann = await operator();
  await drives(ann, -0.2);
  ann.end();
  await until('it stands when the operator has gone', () => speed() < 0.01);
});
