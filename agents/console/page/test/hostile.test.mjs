// The gateway before strangers: wrong pages, wrong keys, broken frames, crowds. It needs no robot.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {randomBytes} from 'node:crypto';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import http from 'node:http';
import https from 'node:https';
import net from 'node:net';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {after, before, test} from 'node:test';
import {output, start, until} from './processes.mjs';
import {frame, socketTo} from './socket.mjs';

const mostMemory = 80;       // [MB]
const keyFile = join(mkdtempSync(join(tmpdir(), 'saphira-keys-')), 'door-keys');
let gateway, port, key;

before(async () => {
  gateway = start('saphira-console', '--robot', `hostile-${process.pid}`, '--port', '0', '--person-keys', keyFile);
  const address = await until('the address', () => output().match(/open http:\/\/localhost:(\d+)\/#(\w+)/));
  port = Number(address[1]);
  key = address[2];
});
after(async () => {
  gateway.kill('SIGTERM');
  const [code] = await new Promise(resolve => gateway.on('exit', (...end) => resolve(end)));
  assert.equal(code, 0, output());
  rmSync(dirname(keyFile), {recursive: true});
});

function get(path, headers = {}) {
  return new Promise((resolve, reject) => {
    const request = http.get({host: '127.0.0.1', port, path, headers, agent: false}, response => {
      let body = '';
      response.on('data', data => { body += data; });
      response.on('end', () => resolve({status: response.statusCode, headers: response.headers, body}));
    });
    request.on('error', reject);
  });
}
const alive = async () => assert.equal((await get('/')).status, 200);

const connect = (protocol, headers) => socketTo(port, protocol, headers);

test('the page comes with a strict security policy, and nothing else is served', async () => {
  const page = await get('/');
  assert.equal(page.status, 200);
  assert.match(page.headers['content-security-policy'], /^default-src 'none'; script-src 'sha256-/);
  assert.doesNotMatch(page.headers['content-security-policy'], /unsafe/);
  assert.equal(page.headers['x-content-type-options'], 'nosniff');
  for (const path of ['/../../../../etc/passwd', '/%2e%2e/%2e%2e/etc/passwd', '/x', '/console.key'])
    assert.notEqual((await get(path)).status, 200, path);
});

test('pages of others and names of others are refused', async () => {
  for (const headers of [{Host: 'evil.example'}, {Host: 'localhost', Origin: 'http://evil.example'},
                         {Host: `localhost:${port}`, Origin: 'null'}]) {
    await assert.rejects(connect('saphira.commands', headers), /403|hang up|reset/i, JSON.stringify(headers));
    assert.notEqual((await get('/', headers).catch(() => ({status: 0}))).status, 200);
  }
  const good = await connect('saphira.commands', {Host: `localhost:${port}`, Origin: `http://localhost:${port}`});
  good.socket.destroy();
});

test('without the right key nothing but watching and the stop', async () => {
  const stranger = await connect('saphira.commands');
  stranger.say({type: 'hello', key: key.replace(/./g, '0'), name: 'mallory'});
  assert.equal((await until('an answer', () => stranger.texts[0])).may_drive, false);
  stranger.say({type: 'take', force: true});
  stranger.say({type: 'goal', reference: 1, words: 'go 3 1'});
  await until('the refusals', () => stranger.texts.filter(text => text.type === 'note').length === 2);
  assert.equal(stranger.texts.filter(text => text.type === 'answer').length, 0);
  stranger.socket.destroy();
  const own = await connect('saphira.commands');
  own.say({type: 'hello', key, name: 'ann'});
  assert.equal((await until('an answer', () => own.texts[0])).may_drive, true);
  own.socket.destroy();
});

test('a person has the rights of their key until it is revoked', async () => {
  const keys = (...words) => {
    const run = spawnSync(join(process.env.SAPHIRA_BIN_DIR, 'saphira'), ['keys', ...words, '--file', keyFile], {encoding: 'utf8'});
    assert.equal(run.status, 0, run.stderr);
    return run.stdout.match(/^[0-9a-f]{32}$/m)?.[0];
  };
  const greet = (key, mayDrive) => until(`a greeting with may_drive ${mayDrive}`, async () => {
    const person = await connect('saphira.commands');
    person.say({type: 'hello', key, name: 'mallory'});
    if ((await until('an answer', () => person.texts[0])).may_drive === mayDrive) return person;
    person.socket.destroy();
    return undefined;
  });
  const bob = keys('add', 'bob', '--right', 'watch'), anna = keys('add', 'anna', '--right', 'drive');
  const driver = await greet(anna, true), watcher = await greet(bob, false);
  driver.say({type: 'estop_reset'});
  watcher.say({type: 'take', force: true});
  for (const person of [driver, watcher])
    await until('the refusal', () => person.texts.some(text => text.type === 'note' && /Your key is to/.test(text.text)));
  keys('revoke', 'anna');
  await until('the end of what the key had open', () => driver.closed);
  const again = await greet(anna, false);
  for (const person of [watcher, again]) person.socket.destroy();
});

test('who says no hello is let go', async () => {
  const silent = await connect('saphira.telemetry');
  const loris = net.connect(port, '127.0.0.1');
  let ended = false;
  loris.on('close', () => { ended = true; }).on('error', () => {});
  loris.write('GET / HTTP/1.1\r\nHost: localhost\r\nX-Slow: ');
  await until('the end of both', () => silent.closed && ended);
  await alive();
});

test('a connection has one answer and ends: a second request is not read', async () => {
  const used = () => readFileSync(`/proc/${gateway.pid}/stat`, 'utf8').split(' ').slice(13, 15).reduce((sum, ticks) => sum + Number(ticks), 0);
  const before = used();
  for (const second of ['', 'GET / HTTP/1.1\r\nHost: localhost\r\n\r\n',
                        'POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello']) {
    let came = '', ended = false;
    const socket = net.connect(port, '127.0.0.1').on('close', () => { ended = true; }).on('error', () => {}).on('data', data => { came += data; });
    socket.write('GET / HTTP/1.1\r\nHost: localhost\r\n\r\n' + second);
    await until('the end', () => ended);
    assert.equal(came.match(/HTTP\/1.1 200/g)?.length, 1, came);
    await alive();
  }
  assert.ok(used() - before < 100, `${used() - before} ticks`);
});

test('broken, huge and half frames', async () => {
  const bad = [
    () => randomBytes(300),
    () => Buffer.from([0x81, 0xff, 0x7f, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1, 2, 3, 4]),  // 2^63 bytes
    () => Buffer.from([0x81, 0xfe, 0xff, 0xff, 0, 0, 0, 0]),                                      // half of one
    () => frame('x'.repeat(60_000)),
    () => frame(randomBytes(200), 2),
    () => Buffer.concat(Array.from({length: 50}, () => Buffer.from([0x01, 0x80, 0, 0, 0, 0]))),    // never ends
    () => frame('['.repeat(4000)),
    () => frame('{"type":"drive","number":-1,"at":"x"}'),
    () => frame('', 8), () => frame('', 9), () => frame('', 15),
  ];
  for (let i = 0; i < 20 * bad.length; ++i) {
    const connection = await connect(i % 2 ? 'saphira.commands' : 'saphira.telemetry');
    connection.say({type: 'hello', key, name: 'ann'});
    connection.socket.write(bad[i % bad.length]());
    if (i % 3) connection.socket.destroy();
    else setTimeout(() => connection.socket.destroy(), 200);
  }
  await alive();
});

test('with a certificate everything is encrypted, and nothing is answered in the clear', async t => {
  const folder = mkdtempSync(join(tmpdir(), 'saphira-https-'));
  const [keyFile, certificate] = [join(folder, 'key.pem'), join(folder, 'certificate.pem')];
  const made = spawnSync('openssl', ['req', '-x509', '-newkey', 'rsa:2048', '-nodes', '-days', '1', '-subj', '/CN=localhost',
    '-addext', 'subjectAltName=DNS:localhost', '-keyout', keyFile, '-out', certificate]);
  assert.equal(made.status, 0, String(made.stderr));
  const secure = start('saphira-console', '--robot', `https-${process.pid}`, '--port', '0', '--certificate', certificate,
    '--certificate-key', keyFile);
  t.after(() => { secure.kill('SIGTERM'); rmSync(folder, {recursive: true}); });
  const [, at, itsKey] = await until('the address', () => output().match(/open https:\/\/localhost:(\d+)\/#(\w+)/));
  const options = {host: 'localhost', port: Number(at), family: 4, agent: false, ca: readFileSync(certificate)};
  const status = () => new Promise((resolve, reject) =>
    https.get(options, response => { response.resume(); resolve(response.statusCode); }).on('error', reject));
  assert.equal(await status(), 200);
  // A browser that does not know the certificate refuses it, and so does the gateway plain HTTP.
  await assert.rejects(new Promise((resolve, reject) => https.get({...options, ca: undefined}, resolve).on('error', reject)), /self.signed/);
  const plain = await new Promise(resolve => http.get({...options, ca: undefined}, response => resolve(response.statusCode)).on('error', () => resolve(0)));
  assert.notEqual(plain, 200);
  const socket = await new Promise((resolve, reject) => {
    const request = https.request({...options, headers: {
      Connection: 'Upgrade', Upgrade: 'websocket', 'Sec-WebSocket-Version': '13', Origin: `https://localhost:${at}`,
      'Sec-WebSocket-Key': randomBytes(16).toString('base64'), 'Sec-WebSocket-Protocol': 'saphira.commands'}});
    request.on('upgrade', (_, upgraded) => resolve(upgraded)).on('error', reject).end();
  });
  let answer = '';
  socket.on('data', data => { answer += data; });
  socket.write(frame(JSON.stringify({type: 'hello', key: itsKey, name: 'ann'})));
  await until('that the key is right', () => answer.includes('"may_drive":true'));
  socket.destroy();
  assert.equal(await status(), 200);
});

test('a thousand connections are a crowd, and no end', async () => {
  const crowd = [];
  for (let i = 0; i < 1000; ++i) crowd.push(net.connect(port, '127.0.0.1').on('error', () => {}));
  await new Promise(resolve => setTimeout(resolve, 500));
  for (const socket of crowd) socket.destroy();
  await until('the page again', async () => (await get('/').catch(() => ({status: 0}))).status === 200);
  const memory = Number(readFileSync(`/proc/${gateway.pid}/status`, 'utf8').match(/VmRSS:\s+(\d+)/)[1]) / 1024;
  assert.ok(memory < mostMemory, `${memory} MB`);
});
