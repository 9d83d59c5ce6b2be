import {randomBytes} from 'node:crypto';
import http from 'node:http';
import https from 'node:https';

// A WebSocket by hand: what it sends need not be right. `texts` has what came, until somebody takes it; `take` is called with bytes. tls: what
// https takes; without it the connection is plain.
export function socketTo(port, protocol, headers = {}, tls = undefined, path = '/') {
  return new Promise((resolve, reject) => {
    const request = (tls ? https : http).request({...tls, host: '127.0.0.1', port, path, agent: false, headers: {
      Connection: 'Upgrade', Upgrade: 'websocket', 'Sec-WebSocket-Version': '13',
      'Sec-WebSocket-Key': randomBytes(16).toString('base64'), 'Sec-WebSocket-Protocol': protocol, ...headers}});
    request.on('upgrade', (response, socket) => {
      const connection = {socket, texts: [], closed: false};
      let rest = Buffer.alloc(0);
      socket.on('data', data => {
        rest = Buffer.concat([rest, data]);
        for (;;) {
          if (rest.length < 2) return;
          let size = rest[1] & 127, at = 2;
          if (size === 126) size = rest.length >= 4 ? rest.readUInt16BE(2) : Infinity, at = 4;
          else if (size === 127) size = rest.length >= 10 ? Number(rest.readBigUInt64BE(2)) : Infinity, at = 10;
          if (rest.length < at + size) return;
          if ((rest[0] & 15) === 1) connection.texts.push(JSON.parse(rest.subarray(at, at + size)));
          if ((rest[0] & 15) === 9) socket.write(frame(rest.subarray(at, at + size), 10));
          if ((rest[0] & 15) === 2) connection.take?.(rest.subarray(at, at + size));
          rest = rest.subarray(at + size);
        }
      });
      socket.on('error', () => {});
      socket.on('close', () => { connection.closed = true; });
      connection.say = message => socket.write(frame(JSON.stringify(message)));
      resolve(connection);
    });
    request.on('response', response => reject(new Error(`status ${response.statusCode}`)));
    request.on('error', reject);
    request.end();
  });
}
export function frame(text, opcode = 1) {
  const payload = Buffer.from(text), mask = randomBytes(4);
  const head = payload.length < 126 ? Buffer.from([0x80 | opcode, 0x80 | payload.length])
    : Buffer.from([0x80 | opcode, 0x80 | 126, payload.length >> 8, payload.length & 255]);
  return Buffer.concat([head, mask, payload.map((byte, i) => byte ^ mask[i % 4])]);
}
