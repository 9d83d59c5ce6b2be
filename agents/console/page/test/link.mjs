// A bad network between a page and the gateway.
import net from 'node:net';
import {sleep} from './processes.mjs';

const resend = 200;      // [ms] until TCP repeats what is lost, beside the way there and back
const overtaken = 60;    // [ms] later than its turn
const segment = 1448;    // [bytes] of a packet

// The same losses in each run.
function chance(seed) {
  let state = seed;
  return () => (state = (state * 1103515245 + 12345) % 2147483648) / 2147483648;
}

// A link of its own: delay and its spread [ms], each way; loss: of a packet; reorder: share that others overtake. What
// is lost is sent again, and what follows waits for it and for what was overtaken, as TCP does. [bytes/s]. down, up: [bytes]
// from the port and to it.
export async function link(port, {delay = 0, spread = 0, loss = 0, reorder = 0, rate = Infinity} = {}) {
  const state = {cut: false, down: 0, up: 0};
  const random = chance(7);
  const carry = (from, to, way) => {
    let last = Promise.resolve(), free = 0;
    from.on('data', data => {
      state[way] += data.length;
      const late = reorder > 0 && random() < reorder ? overtaken : 0;
      const lost = random() < 1 - (1 - loss) ** Math.ceil(data.length / segment);
      free = Math.max(free, Date.now()) + 1000 * data.length / rate;
      const due = free + delay + spread * (2 * random() - 1) + (lost ? resend + 2 * delay : late);
      last = last.then(async () => {
        while ((Date.now() < due || state.cut) && !to.destroyed) await sleep(5);
        if (!to.destroyed) to.write(data);
      });
    });
    from.on('close', () => last.then(() => to.destroy())).on('error', () => {});
  };
  const server = net.createServer(near => {
    const far = net.connect(port, '127.0.0.1');
    carry(near, far, 'up');
    carry(far, near, 'down');
  });
  server.unref();
  await new Promise(resolve => server.listen(0, '127.0.0.1', resolve));
  return Object.assign(state, {port: server.address().port});
}
