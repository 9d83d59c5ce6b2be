// Console, MCP and relay behind the reverse proxies of Debian: on another port, under a path, with TLS before a
// plain program. They need no robot.
import assert from 'node:assert/strict';
import {execFileSync, spawn} from 'node:child_process';
import {mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import https from 'node:https';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {end, freePorts, output, start, until} from './processes.mjs';
import {socketTo} from './socket.mjs';

const name = 'robot.example';
const token = '0123456789abcdef0123456789abcdef';
const folder = mkdtempSync(join(tmpdir(), 'saphira-proxy-'));
const file = each => join(folder, each);
const children = [];
let consolePort, key, mcpPort, mcpToken, ports, trust;

function run(program, ...words) {
  const child = start(program, ...words);
  children.push(child);
  return child;
}
function proxy(program, ...words) {
  const child = spawn(program, words, {stdio: 'ignore', env: {...process.env, PATH: `${process.env.PATH}:/usr/sbin`}});
  children.push(child);
}
const websocket = 'proxy_http_version 1.1; proxy_set_header Upgrade $http_upgrade; proxy_set_header Connection "upgrade";';
// Ports 0 and 1: nginx, which names the host without the port, or leaves out the host as it does by itself.
function nginx() {
  const server = (port, more) => `server {
    listen 127.0.0.1:${port} ssl; ssl_certificate ${file('proxy.pem')}; ssl_certificate_key ${file('proxy.key')};
    ${more}
    location /robot/ { proxy_pass http://127.0.0.1:${consolePort}/; ${websocket} }
    location /model/ { proxy_pass http://127.0.0.1:${mcpPort}/; proxy_buffering off; }
    location ~ ^/(dial|carry)/ { proxy_pass http://127.0.0.1:${ports[3]}; ${websocket} }
  }`;
  writeFileSync(file('nginx.conf'), `daemon off; pid ${file('nginx.pid')}; error_log ${file('nginx.log')};
    events {} http { access_log off; ${['body', 'proxy', 'fastcgi', 'uwsgi', 'scgi'].map(each =>
    `${each === 'body' ? 'client_body' : each}_temp_path ${file(each)};`).join(' ')}
    ${server(ports[0], 'proxy_set_header Host $host; proxy_set_header X-Forwarded-For $remote_addr;')} ${server(ports[1], '')} }`);
  proxy('nginx', '-c', file('nginx.conf'), '-p', folder);
}
// Port 2: haproxy, which passes host and path on as they are, and says nothing of itself.
function haproxy() {
  writeFileSync(file('both.pem'), readFileSync(file('proxy.pem'), 'utf8') + readFileSync(file('proxy.key'), 'utf8'));
  writeFileSync(file('haproxy.cfg'), `defaults
  mode http
  timeout connect 5s
  timeout client 60s
  timeout server 60s
frontend all
  bind 127.0.0.1:${ports[2]} ssl crt ${file('both.pem')}
  use_backend model if { path_beg /model/ }
  default_backend console
backend console
  server one 127.0.0.1:${consolePort}
backend model
  server one 127.0.0.1:${mcpPort}
`);
  proxy('haproxy', '-f', file('haproxy.cfg'));
}

before(async () => {
  execFileSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes',
    '-keyout', file('proxy.key'), '-out', file('proxy.pem'), '-days', '2', '-subj', `/CN=${name}`,
    '-addext', `subjectAltName=DNS:${name},DNS:localhost`], {stdio: 'ignore'});
  trust = {ca: readFileSync(file('proxy.pem')), servername: name};
  ports = await freePorts(5);
  const robot = `proxy-${process.pid}`;
  run('saphira-console', '--robot', robot, '--port', '0', '--host-name', name);
  run('saphira-mcp', '--robot', robot, '--http', '0', '--token-file', file('mcp.token'), '--host-name', name);
  [, consolePort, key] = await until('the console', () => output().match(/open http:\/\/localhost:(\d+)\/#(\w+)/));
  [, mcpPort] = await until('MCP', () => output().match(/http:\/\/127\.0\.0\.1:(\d+)\/mcp/));
  mcpToken = readFileSync(file('mcp.token'), 'utf8').split('\n')[0];
  mkdirSync(file('logs'));   // nginx looks for its own beside the file
  nginx();
  haproxy();
  for (const port of ports.slice(0, 3)) await until('a proxy', () => get(port, '/robot/').then(() => true, () => false));
});
after(async () => {
  for (const child of children) await end(child);
  rmSync(folder, {recursive: true, force: true});
});

function ask(port, path, options, body) {
  return new Promise((resolve, reject) => {
    const request = https.request({...trust, host: '127.0.0.1', port, path, agent: false, ...options}, response => {
      let text = '';
      response.on('data', data => { text += data; });
      response.on('end', () => resolve({status: response.statusCode, text, headers: response.headers}));
    });
    request.on('error', reject);
    request.end(body);
  });
}
const get = (port, path, host = `${name}:${port}`) => ask(port, path, {headers: {Host: host}});
// What the gateway answers to a page that says this.
async function greeting(port, protocol, hello, headers, tls, path) {
  const socket = await socketTo(port, protocol, headers, tls, path);
  socket.say({type: 'hello', key: '', name: 'ann', ...hello});
  const answer = await until('the greeting', () => socket.texts.find(text => text.type === 'hello'));
  socket.socket.destroy();
  return answer;
}

for (const [which, what] of [[0, 'nginx with the name of the host'], [1, 'nginx as it is'], [2, 'haproxy as it is']]) {
  test(`${what}: the page and its connections come, and whoever comes by it needs the key`, async () => {
    const port = ports[which];
    const page = await get(port, '/robot/');
    assert.equal(page.status, 200);
    assert.doesNotMatch(page.text, /(src|href)="\//);
    for (const [, path] of page.text.matchAll(/(?:src|href)="([\w.]+)"/g))
      assert.equal((await get(port, `/robot/${path}`)).status, 200, path);
    const headers = {Host: `${name}:${port}`, Origin: `https://${name}:${port}`};
    const by = (hello, protocol = 'saphira.commands') => greeting(port, protocol, hello, headers, trust, '/robot/');
    assert.equal((await by({})).may_watch, false);
    assert.equal((await by({}, 'saphira.telemetry')).may_watch, false);
    assert.deepEqual([(await by({key})).may_watch, (await by({key})).may_drive], [true, true]);
  });
  test(`${what}: a page of somebody else is refused, and hears the remedy`, async () => {
    const port = ports[which], origin = 'https://evil.example';
    await assert.rejects(socketTo(port, 'saphira.commands', {Host: `${name}:${port}`, Origin: origin}, trust, '/robot/'));
    assert.match((await get(port, `/robot/access?origin=${encodeURIComponent(origin)}`)).text, /--host-name evil\.example$/);
    assert.equal((await get(port, `/robot/access?origin=${encodeURIComponent(`https://${name}:${port}`)}`)).text, '');
  });
  test(`${what}: MCP answers, also to a body in chunks`, async () => {
    const initialize = JSON.stringify({jsonrpc: '2.0', id: 1, method: 'initialize', params: {protocolVersion: '2025-06-18'}});
    for (const more of [{'Transfer-Encoding': 'chunked'}, {'Content-Length': initialize.length}]) {
      const answer = await ask(ports[which], '/model/mcp', {method: 'POST', headers: {Host: `${name}:${ports[which]}`,
        Authorization: `Bearer ${mcpToken}`, ...more}}, initialize);
      assert.equal(answer.status, 200, answer.text);
      assert.equal(JSON.parse(answer.text).result.serverInfo.name, 'saphira');
    }
  });
}
test('a proxy with a name that nobody has said is refused, and the remedy is an option of that program', async () => {
  const page = await get(ports[2], '/robot/', 'other.example');
  assert.equal(page.status, 403);
  assert.match(page.text, /--host-name other\.example$/m);
  for (const program of ['saphira-console', 'saphira-mcp'])
    assert.match(execFileSync(join(process.env.SAPHIRA_BIN_DIR, program), ['--help'], {encoding: 'utf8'}), /--host-name/);
});
test('who comes directly watches without the key, unless it is always asked for', async () => {
  const direct = port => greeting(port, 'saphira.commands', {}, {Host: `localhost:${port}`});
  assert.equal((await direct(consolePort)).may_watch, true);
  const before = output().length;
  run('saphira-console', '--robot', `always-${process.pid}`, '--port', '0', '--always-key');
  const [, port] = await until('the console', () => output().slice(before).match(/open http:\/\/localhost:(\d+)\//));
  assert.equal((await direct(port)).may_watch, false);
});
test('a robot dials a relay behind a proxy that encrypts for it', async () => {
  writeFileSync(file('robots'), `pioneer ${ports[4]} ${token}\n`, {mode: 0o600});
  writeFileSync(file('token'), `${token}\n`, {mode: 0o600});
  run('saphira-relay', '--robots', file('robots'), '--dial-port', `${ports[3]}`, '--listen', '127.0.0.1');
  await until('the relay', () => output().includes('listens for robots'));
  run('saphira-console', '--robot', `dials-${process.pid}`, '--port', '0', '--certificate', file('proxy.pem'),
    '--certificate-key', file('proxy.key'), '--dial', `wss://localhost:${ports[0]}/pioneer`,
    '--dial-token-file', file('token'), '--dial-authority', file('proxy.pem'));
  await until('the robot', () => output().includes('pioneer has dialled in'));
  assert.equal((await get(ports[4], '/', `localhost:${ports[4]}`)).status, 200);
});
