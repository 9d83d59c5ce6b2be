// The gateway is beside the page: at the root of a host, or under a path of a proxy.
const here = new URL('.', location.href);
// Robots under paths of one host have a key each.
const keyName = here.pathname === '/' ? 'saphira key' : `saphira key ${here.pathname}`;

export function stored(name: string): string {
  try {
    return localStorage.getItem(name) ?? '';
  } catch {
    return '';
  }
}
export function store(name: string, value: string) {
  try {
    localStorage.setItem(name, value);
  } catch {
    // A browser that keeps nothing: the key holds for as long as the page is open.
  }
}
// The key behind the # of the address, or the one from before.
export function storedKey(): string {
  const given = location.hash.slice(1);
  if (!given) return stored(keyName);
  store(keyName, given);
  history.replaceState(null, '', location.pathname);
  return given;
}

export function socketOf(protocol: string): WebSocket {
  const address = new URL(here);
  address.protocol = here.protocol === 'https:' ? 'wss:' : 'ws:';
  return new WebSocket(address, protocol);
}

// Why no WebSocket of this page gets through, in words; empty where the gateway is not there at all.
export async function barrier(): Promise<string> {
  try {
    const answer = await fetch(new URL(`access?origin=${encodeURIComponent(location.origin)}`, here));
    if (!answer.ok || !answer.headers.get('content-type')?.startsWith('text/plain')) return '';
    const why = await answer.text();
    return why ? `The console lets this page watch nothing: ${why}.`
      : 'A proxy between this page and the console lets no WebSocket through: it has to pass on the headers Upgrade and '
        + 'Connection by HTTP/1.1 (nginx: proxy_http_version 1.1; proxy_set_header Upgrade $http_upgrade; '
        + 'proxy_set_header Connection "upgrade";).';
  } catch {
    return '';
  }
}
