// The client that test_generated_clients.py makes: as a user's first try, with the server's address.
export default {
  symcell: {
    input: process.env.SYMCELL_DESCRIPTION,
    output: { target: process.env.SYMCELL_ORVAL_CLIENT, client: 'fetch', baseUrl: process.env.SYMCELL_URL },
  },
};
